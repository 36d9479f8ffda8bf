#include "slam/surface.h"

#include <algorithm>
#include <cmath>

namespace rubble::slam {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

double distance(const TPoint2D& a, const TPoint2D& b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// Unit vector along the surface at point i, from its neighbours; zero where it has none.
TPoint2D along(const std::vector<SurfacePoint>& points, std::size_t i) {
  const bool follows = i > 0 && points[i - 1].joined;
  const bool goes_on = points[i].joined && i + 1 < points.size();
  const TPoint2D& a = points[follows ? i - 1 : i].p;
  const TPoint2D& b = points[goes_on ? i + 1 : i].p;
  const double length = distance(a, b);
  return length > 0.0 ? TPoint2D{(b.x - a.x) / length, (b.y - a.y) / length} : TPoint2D{};
}

bool occupied_near(const CountMap& map, const TPoint2D& p) {
  const GridFrame& frame = map.frame();
  const Cell c = frame.cell(p);
  if (c.x < 1 || c.y < 1 || c.x > frame.width - 2 || c.y > frame.height - 2) return false;
  for (int y = c.y - 1; y <= c.y + 1; ++y) {
    const std::uint8_t* row = map.p_occ_plane() + frame.index({c.x - 1, y});
    if ((row[0] | row[1] | row[2]) != 0) return true;
  }
  return false;
}

}  // namespace

Surface surface_of(const ScanPoints& scan, const SurfaceConfig& config) {
  const std::vector<ScanRay>& rays = scan.rays;
  const auto connected = [&](std::size_t i) {
    return rays[i].joined && rays[i + 1].hit && distance(rays[i].end, rays[i + 1].end) <= config.max_gap;
  };
  Surface surface;
  surface.origin = scan.origin;
  std::size_t hit = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!rays[i].hit) continue;
    // The length of a run follows from its first range alone. To wait for a return that lies `spacing` away from the
    // last one would prefer long ranges on one side and short ones on the other, and turn every match a little.
    const double step = std::max(1e-3, distance(rays[i].end, scan.origin) * scan.beam_width);
    const std::size_t wanted = static_cast<std::size_t>(std::max(1.0, config.spacing / step));
    SurfacePoint point{rays[i].end, hit, 1, false};
    for (; point.hits < wanted && connected(i); ++point.hits) {
      ++i;
      point.p = {point.p.x + rays[i].end.x, point.p.y + rays[i].end.y};
    }
    const double n = static_cast<double>(point.hits);
    point.p = {point.p.x / n, point.p.y / n};
    point.joined = connected(i);
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
  for (const SurfacePoint& point : now.points) {
    if (last.covers(T_last_now.composePoint(point.p), margin)) part.points.push_back(point);
  }
  return part;
}

Surface known_part(const Surface& now, const CountMap& map, const TPose2D& T_map_base, double margin) {
  Surface part;
  part.origin = now.origin;
  for (std::size_t i = 0; i < now.points.size(); ++i) {
    const TPoint2D p = T_map_base.composePoint(now.points[i].p);
    const TPoint2D t = T_map_base.composePoint(along(now.points, i)) - TPoint2D{T_map_base.x, T_map_base.y};
    if (occupied_near(map, p) && occupied_near(map, {p.x + margin * t.x, p.y + margin * t.y}) &&
        occupied_near(map, {p.x - margin * t.x, p.y - margin * t.y})) {
      part.points.push_back(now.points[i]);
    }
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
