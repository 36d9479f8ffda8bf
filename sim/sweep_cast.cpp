#include "sim/sweep_cast.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angle.h"
#include "sim/simd.h"

namespace rubble::sim {
namespace {

using Eigen::Vector3d;

constexpr float kSeam = 2e-5f;  ///< faces reach so far beyond their edges: no light through seams [m]
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr std::size_t kMostCorners = ScanFaces::kMostCorners;

/// A linear function of position for four rays at once: value(o + t d) = at_origin + t * along.
struct Plane4 {
  Float4 x, y, z, c;
  Plane4() = default;
  Plane4(const Vector3d& normal, double offset)
      : x(splat(static_cast<float>(normal.x()))),
        y(splat(static_cast<float>(normal.y()))),
        z(splat(static_cast<float>(normal.z()))),
        c(splat(static_cast<float>(offset))) {}
};

/// Distance from the origin to the segment a b in the plane.
double distance_to_segment(double ax, double ay, double bx, double by) {
  const double dx = bx - ax;
  const double dy = by - ay;
  const double length2 = dx * dx + dy * dy;
  const double u = length2 > 0.0 ? std::clamp(-(ax * dx + ay * dy) / length2, 0.0, 1.0) : 0.0;
  const double x = ax + u * dx;
  const double y = ay + u * dy;
  return std::sqrt(x * x + y * y);
}

/// An angle in [-2 pi, 2 pi] the short way round.
double half_turn(double a) { return a > kPi ? a - 2.0 * kPi : (a < -kPi ? a + 2.0 * kPi : a); }

}  // namespace

/// Bearings low .. high with a margin on both sides as groups of beams; what lies beyond pi behind comes round.
void SweepCast::spans(double low, double high, double margin, const BeamTable& table, std::vector<Span>& found) const {
  found.clear();
  const std::size_t groups = table.cosine.size() / 4;
  low -= margin;
  high += margin;
  if (high - low >= 2.0 * kPi) {
    found.push_back({0, groups});
    return;
  }
  const auto add = [&](double from, double to) {
    const double first = std::floor((from - table.angle_min) / table.angle_step);
    const double last = std::ceil((to - table.angle_min) / table.angle_step);
    if (last < 0.0 || first >= static_cast<double>(table.count)) return;
    const std::size_t begin = first > 0.0 ? static_cast<std::size_t>(first) / 4 : 0;
    const std::size_t end = std::min(groups, static_cast<std::size_t>(last) / 4 + 1);
    found.push_back({begin, end});
  };
  // A bearing is one of three turns; each shift that reaches the scanner's sector gives a part.
  for (const double shift : {-2.0 * kPi, 0.0, 2.0 * kPi}) add(low + shift, high + shift);
}

SweepCast::Bearings SweepCast::bearings(const Vector3d* vertices, const double* z, std::size_t n, double slack,
                                        const Placement& laser) const {
  // The part of the polygon between the planes z = -slack and z = slack, corner by corner.
  double x[4 * kMostCorners], y[4 * kMostCorners];
  std::size_t count = 0;
  const auto add = [&](const Vector3d& p) {
    const Vector3d q = p - laser.p;
    x[count] = laser.R.col(0).dot(q);
    y[count] = laser.R.col(1).dot(q);
    ++count;
  };
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = i + 1 < n ? i + 1 : 0;
    const double rise = z[k] - z[i];
    double from = 0.0;
    double to = 1.0;
    if (z[i] > slack) from = z[k] > slack ? 2.0 : (slack - z[i]) / rise;
    if (z[i] < -slack) from = z[k] < -slack ? 2.0 : (-slack - z[i]) / rise;
    if (from > 1.0) continue;
    if (z[k] > slack) to = (slack - z[i]) / rise;
    if (z[k] < -slack) to = (-slack - z[i]) / rise;
    add(vertices[i] + from * (vertices[k] - vertices[i]));
    if (to < 1.0 || from > 0.0) add(vertices[i] + to * (vertices[k] - vertices[i]));
  }
  Bearings b;
  if (count == 0) return b;
  const double first = rough_atan2(y[0], x[0]);
  double bearing = first;
  b.low = b.high = first;
  b.nearest = distance_to_segment(x[count - 1], y[count - 1], x[0], y[0]);
  for (std::size_t i = 1; i < count; ++i) {
    b.nearest = std::min(b.nearest, distance_to_segment(x[i - 1], y[i - 1], x[i], y[i]));
    bearing += half_turn(rough_atan2(y[i], x[i]) - bearing);
    b.low = std::min(b.low, bearing);
    b.high = std::max(b.high, bearing);
  }
  b.around = std::abs(bearing + half_turn(first - bearing) - first) > 1.0;
  return b;
}

void SweepCast::meet(const ScanFaces::Polygon& polygon, const Beams& beams, const BeamTable& table, double max_range) {
  const Vector3d* vertices = faces_.vertices(polygon);
  const std::size_t n = polygon.count;
  // Height over the scan plane at mid sweep; a face all above or all below what that plane sweeps is never met.
  double z[kMostCorners];
  double highest = -kInf;
  double lowest = kInf;
  const double slack = beams.tilt * (max_range + beams.travel) + beams.lift + 1e-4;
  const Vector3d up = beams.middle.R.col(2);
  for (std::size_t i = 0; i < n; ++i) {
    z[i] = up.dot(vertices[i] - beams.middle.p);
    highest = std::max(highest, z[i]);
    lowest = std::min(lowest, z[i]);
  }
  if (lowest > slack || highest < -slack) return;
  const Bearings b = bearings(vertices, z, n, slack, beams.middle);
  if (b.nearest > max_range + beams.travel) return;
  // How far the bearing of a point of the face can differ between its beam's pose and the middle one.
  const double margin = b.around || b.nearest < 0.05 ? kPi
                                                     : beams.turn + beams.tilt * (beams.tilt + slack / b.nearest) +
                                                           beams.travel / b.nearest + 2.0 * kRoughAtan2Error;
  spans(b.low, b.high, margin, table, spans_);
  if (spans_.empty()) return;

  // Only edges that cross the scan plane bound what the beams meet.
  const Plane4 plane(polygon.normal, polygon.offset - polygon.normal.dot(beams.middle.p));
  Plane4 edges[kMostCorners];
  std::size_t edge_count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = i + 1 < n ? i + 1 : 0;
    if ((z[i] > slack && z[k] > slack) || (z[i] < -slack && z[k] < -slack)) continue;
    const Vector3d along = vertices[k] - vertices[i];
    if (along.squaredNorm() < 1e-18) continue;
    const Vector3d inward = polygon.normal.cross(along).normalized();
    edges[edge_count++] = Plane4(inward, inward.dot(vertices[i] - beams.middle.p) - static_cast<double>(kSeam));
  }
  const Float4 zero = splat(0.0f);
  for (const Span& span : spans_) {
    for (std::size_t i = 4 * span.begin; i < 4 * span.end; i += 4) {
      const Float4 ox = load4(&beams.ox[i]), oy = load4(&beams.oy[i]), oz = load4(&beams.oz[i]);
      const Float4 dx = load4(&beams.dx[i]), dy = load4(&beams.dy[i]), dz = load4(&beams.dz[i]);
      const Float4 gap = plane.c - (plane.x * ox + plane.y * oy + plane.z * oz);
      const Float4 closing = plane.x * dx + plane.y * dy + plane.z * dz;
      const Float4 t = gap / closing;
      const Float4 best = load4(&best_[i]);
      Int4 hit = (closing < zero) & (t > zero) & (t < best);
      const Float4 px = ox + t * dx, py = oy + t * dy, pz = oz + t * dz;
      for (std::size_t e = 0; e < edge_count; ++e) {
        hit &= edges[e].x * px + edges[e].y * py + edges[e].z * pz >= edges[e].c;
      }
      store4(&best_[i], hit ? t : best);
    }
  }
}

void SweepCast::meet(const Sphere& sphere, const Beams& beams, const BeamTable& table, double max_range) {
  const Vector3d centre = Vector3d(sphere.x, sphere.y, sphere.z) - beams.middle.p;
  const double distance = centre.norm();
  if (distance > max_range + sphere.radius + beams.travel) return;
  const double slack = beams.tilt * (max_range + beams.travel) + beams.lift + 1e-4;
  const double height = beams.middle.R.col(2).dot(centre);
  if (std::abs(height) > sphere.radius + slack) return;
  const double flat = std::sqrt(std::max(0.0, distance * distance - height * height));
  const double clear = flat - sphere.radius - beams.travel;
  double bearing = 0.0;
  double margin = kPi;
  if (clear > 0.05) {
    bearing = rough_atan2(beams.middle.R.col(1).dot(centre), beams.middle.R.col(0).dot(centre));
    margin = std::asin(sphere.radius / flat) + beams.turn +
             beams.tilt * (beams.tilt + (std::abs(height) + sphere.radius) / clear) + beams.travel / clear +
             2.0 * kRoughAtan2Error;
  }
  spans(bearing, bearing, margin, table, spans_);
  const Float4 cx = splat(static_cast<float>(centre.x()));
  const Float4 cy = splat(static_cast<float>(centre.y()));
  const Float4 cz = splat(static_cast<float>(centre.z()));
  const Float4 r2 = splat(static_cast<float>(sphere.radius * sphere.radius));
  const Float4 zero = splat(0.0f);
  for (const Span& span : spans_) {
    for (std::size_t i = 4 * span.begin; i < 4 * span.end; i += 4) {
      const Float4 dx = load4(&beams.dx[i]), dy = load4(&beams.dy[i]), dz = load4(&beams.dz[i]);
      const Float4 tx = cx - load4(&beams.ox[i]), ty = cy - load4(&beams.oy[i]), tz = cz - load4(&beams.oz[i]);
      const Float4 along = tx * dx + ty * dy + tz * dz;
      // The foot of the perpendicular keeps its digits where |c|^2 - along^2 would lose them.
      const Float4 fx = tx - along * dx, fy = ty - along * dy, fz = tz - along * dz;
      const Float4 half2 = r2 - (fx * fx + fy * fy + fz * fz);
      const Float4 best = load4(&best_[i]);
      const Int4 touched = half2 >= zero;
      if (!any4(touched)) continue;
      const Float4 t = along - sqrt4(max4(half2, zero));
      const Int4 hit = touched & (t > zero) & (t < best);
      store4(&best_[i], hit ? t : best);
    }
  }
}

void SweepCast::cast(const Beams& beams, const BeamTable& table, double max_range, const std::vector<Sphere>& spheres,
                     std::vector<float>& ranges) {
  best_.assign(beams.ox.size(), kInf);
  faces_.near(beams.middle.p, max_range, beams.travel + 1e-3, near_);
  for (const std::uint32_t i : near_) meet(faces_.polygon(i), beams, table, max_range);
  for (const Sphere& sphere : spheres) meet(sphere, beams, table, max_range);
  ranges.resize(beams.count);
  const float longest = static_cast<float>(max_range);
  for (std::size_t i = 0; i < beams.count; ++i) ranges[i] = best_[i] <= longest ? best_[i] : kInf;
}

}  // namespace rubble::sim
