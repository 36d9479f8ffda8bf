#include "slam/scan/surface.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "base/planar.h"

namespace rubble::slam {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

Surface surface_of(const ScanPoints& scan, const SurfaceConfig& config) {
  const std::vector<ScanRay>& rays = scan.rays;
  const auto range = [&](std::size_t i) { return distance(rays[i].end, scan.origin); };
  const auto beams_apart = [&](std::size_t i, std::size_t j) { return std::abs(rays[i].beam - rays[j].beam); };
  const auto connected = [&](std::size_t i) {
    if (i + 1 == rays.size() || !rays[i + 1].hit || beams_apart(i, i + 1) > config.max_missing + 1) return false;
    const double most = std::max(config.max_gap, config.flattest * scan.beam_width * std::min(range(i), range(i + 1)));
    return distance(rays[i].end, rays[i + 1].end) <= most;
  };
  // A surface that ends next to a farther one really ends there; else it goes on where this scan cannot see it.
  const auto fades = [&](std::size_t end, std::size_t next) {
    return next >= rays.size() || beams_apart(end, next) > 1 || !rays[next].hit || range(next) < range(end);
  };
  Surface surface;
  surface.origin = scan.origin;
  std::size_t hit = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!rays[i].hit) continue;
    // The length of a run follows from its first range alone. To wait for a return that lies `spacing` away from the
    // last one would prefer long ranges on one side and short ones on the other, and turn every match a little.
    const double step = std::max(1e-3, range(i) * scan.beam_width);
    const std::size_t wanted = static_cast<std::size_t>(std::max(1.0, config.spacing / step));
    SurfacePoint point;
    point.p = rays[i].end;
    point.first_hit = hit;
    point.fades_before = fades(i, i - 1);  // for i = 0: beyond the last
    for (; point.hits < wanted && connected(i); ++point.hits) {
      ++i;
      point.p = {point.p.x + rays[i].end.x, point.p.y + rays[i].end.y};
    }
    const double n = static_cast<double>(point.hits);
    point.p = {point.p.x / n, point.p.y / n};
    point.joined = connected(i);
    point.fades_after = fades(i, i + 1);
    hit += point.hits;
    surface.points.push_back(point);
  }
  return surface;
}

SurfaceCoverage::SurfaceCoverage(const Surface& surface) : origin_(surface.origin) {
  const std::vector<SurfacePoint>& points = surface.points;
  if (points.empty()) return;
  first_ = std::atan2(points.front().p.y - origin_.y, points.front().p.x - origin_.x);
  double from_start = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    from_start = i > 0 && points[i - 1].joined ? from_start + distance(points[i - 1].p, points[i].p) : 0.0;
    bearings_.push_back({bearing(points[i].p), from_start, points[i].joined});
  }
  double to_end = 0.0;
  for (std::size_t i = points.size(); i-- > 0;) {
    to_end = points[i].joined && i + 1 < points.size() ? to_end + distance(points[i].p, points[i + 1].p) : 0.0;
    bearings_[i].to_the_rim = std::min(bearings_[i].to_the_rim, to_end);
  }
}

/// In [first, first + 2 pi): scans of more than half a turn must not break at +-180 deg.
double SurfaceCoverage::bearing(const TPoint2D& p) const {
  const double angle = std::atan2(p.y - origin_.y, p.x - origin_.x);
  return angle < first_ ? angle + 2.0 * kPi : angle;
}

bool SurfaceCoverage::covers(const TPoint2D& p, double margin) const {
  const auto after = std::upper_bound(bearings_.begin(), bearings_.end(), bearing(p),
                                      [](double angle, const Bearing& b) { return angle < b.angle; });
  if (after == bearings_.begin() || after == bearings_.end()) return false;
  const auto before = after - 1;
  return before->joined && before->to_the_rim >= margin && after->to_the_rim >= margin;
}

Surface covered_part(const Surface& now, const SurfaceCoverage& last, const TPose2D& T_last_now, double margin) {
  Surface part;
  part.origin = now.origin;
  const PlanarTransform to_last(T_last_now);
  for (const SurfacePoint& point : now.points) {
    if (last.covers(to_last(point.p), margin)) part.points.push_back(point);
  }
  return part;
}

Surface settled_part(const Surface& now, double margin) {
  const std::vector<SurfacePoint>& points = now.points;
  const double far = std::numeric_limits<double>::infinity();
  std::vector<double> to_the_rim(points.size());
  double length = far;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool follows = i > 0 && points[i - 1].joined;
    length = follows ? length + distance(points[i - 1].p, points[i].p) : (points[i].fades_before ? 0.0 : far);
    to_the_rim[i] = length;
  }
  for (std::size_t i = points.size(); i-- > 0;) {
    const bool goes_on = points[i].joined && i + 1 < points.size();
    length = goes_on ? length + distance(points[i].p, points[i + 1].p) : (points[i].fades_after ? 0.0 : far);
    to_the_rim[i] = std::min(to_the_rim[i], length);
  }
  Surface part;
  part.origin = now.origin;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (to_the_rim[i] >= margin) part.points.push_back(points[i]);
  }
  return part;
}

std::vector<TPoint2D> hits_of(const Surface& part, const ScanPoints& scan) {
  std::vector<TPoint2D> hits;
  hits.reserve(scan.hits.size());
  for (const SurfacePoint& point : part.points) {
    const auto first = scan.hits.begin() + static_cast<std::ptrdiff_t>(point.first_hit);
    hits.insert(hits.end(), first, first + static_cast<std::ptrdiff_t>(point.hits));
  }
  return hits;
}

}  // namespace rubble::slam
