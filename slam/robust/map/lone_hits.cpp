#include "slam/robust/map/lone_hits.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "base/planar.h"

namespace rubble::slam {

namespace {

constexpr double kAlone = 0.15;       ///< a hit this far from those beside it stands alone [m] ...
constexpr double kAloneBeams = 12.0;  ///< ... or so many times what lies between two beams there
constexpr int kBeside = 2;            ///< beams

}  // namespace

void drop_lone_hits(ScanPoints& points) {
  std::vector<std::size_t> hits;
  hits.reserve(points.hits.size());
  for (std::size_t i = 0; i < points.rays.size(); ++i)
    if (points.rays[i].hit) hits.push_back(i);
  const auto apart = [&](std::size_t a, std::size_t b) {
    const ScanRay& ray = points.rays[hits[a]];
    const ScanRay& other = points.rays[hits[b]];
    const double step = points.beam_width * distance(ray.end, points.origin);
    return std::abs(other.beam - ray.beam) > kBeside ||
           distance(ray.end, other.end) > std::max(kAlone, kAloneBeams * step);
  };
  std::vector<char> alone(points.rays.size(), 0);
  bool any = false;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!((i == 0 || apart(i, i - 1)) && (i + 1 == hits.size() || apart(i, i + 1)))) continue;
    alone[hits[i]] = 1;
    any = true;
    if (hits[i] > 0) points.rays[hits[i] - 1].joined = false;
  }
  if (!any) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.rays.size(); ++i)
    if (alone[i] == 0) points.rays[kept++] = points.rays[i];
  points.rays.resize(kept);
  points.hits.clear();
  for (const ScanRay& ray : points.rays)
    if (ray.hit) points.hits.push_back(ray.end);
}

}  // namespace rubble::slam
