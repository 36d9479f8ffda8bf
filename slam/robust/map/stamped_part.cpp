#include "slam/robust/map/stamped_part.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/planar.h"

namespace rubble::slam {

using mrpt::math::TPoint2D;

namespace {

/// The length of beams at which they pass `area`, where longer ones end there and shorter ones (ascending) as they do;
/// at most the longest one's.
double length_for(const std::vector<double>& lengths, double area, double beam_width) {
  double left = 2.0 * area / beam_width;
  auto longer = static_cast<double>(lengths.size());
  for (const double length : lengths) {
    if (longer * length * length > left) return std::sqrt(left / longer);
    left -= length * length;
    longer -= 1.0;
  }
  return lengths.back();
}

}  // namespace

void cut_to(const StampedPart& part, double resolution, ScanPoints& points) {
  if (points.rays.empty()) return;
  std::vector<double> lengths;
  for (const ScanRay& ray : points.rays) lengths.push_back(distance(ray.end, points.origin));
  std::vector<double> ascending = lengths;
  std::sort(ascending.begin(), ascending.end());
  double most = part.reach * resolution;
  if (points.beam_width > 0.0)
    most = std::min(most, length_for(ascending, part.cells * resolution * resolution, points.beam_width));
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    if (lengths[i] <= most) continue;
    ScanRay& ray = points.rays[i];
    ray.end = points.origin + (ray.end - points.origin) * (most / lengths[i]);
    ray.hit = false;
  }
}

}  // namespace rubble::slam
