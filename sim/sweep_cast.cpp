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
constexpr std::size_t kMostCorners = 32;

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
  return std::hypot(ax + u * dx, ay + u * dy);
}

}  // namespace

/// Bearings low .. high, low in [-pi, pi], as groups of beams; the part beyond +pi is behind and comes round.
void SweepCast::spans(double low, double high, const BeamTable& table, std::vector<Span>& found) const {
  found.clear();
  const std::size_t groups = table.cosine.size() / 4;
  const auto add = [&](double from, double to) {
    const double first = std::floor((from - table.angle_min) / table.angle_step);
    const double last = std::ceil((to - table.angle_min) / table.angle_step);
    if (last < 0.0 || first >= static_cast<double>(table.count)) return;
    const std::size_t begin = first > 0.0 ? static_cast<std::size_t>(first) / 4 : 0;
    const std::size_t end = std::min(groups, static_cast<std::size_t>(last) / 4 + 1);
    // Two parts that touch must not share a group, or work is done twice.
    found.push_back({found.empty() ? begin : std::max(begin, found.back().end), end});
  };
  if (high - low >= 2.0 * kPi) {
    found.push_back({0, groups});
    return;
  }
  if (low < -kPi) {
    add(-kPi, high);
    add(low + 2.0 * kPi, kPi);
  } else if (high > kPi) {
    add(-kPi, high - 2.0 * kPi);
    add(low, kPi);
  } else {
    add(low, high);
  }
}

void SweepCast::meet(const ScanFaces::Polygon& polygon, const Beams& beams, const BeamTable& table, double max_range) {
  const Vector3d* vertices = faces_.vertices(polygon);
  const std::size_t n = std::min<std::size_t>(polygon.count, kMostCorners);
  // In the laser's frame at mid sweep; a face all above or all below what the scan plane sweeps is never met.
  double z[kMostCorners];
  double highest = -kInf;
  double lowest = kInf;
  const double slack = beams.turn * (max_range + beams.travel) + beams.travel + 1e-4;
  const Vector3d up = beams.middle.R.col(2);
  for (std::size_t i = 0; i < n; ++i) {
    z[i] = up.dot(vertices[i] - beams.middle.p);
    highest = std::max(highest, z[i]);
    lowest = std::min(lowest, z[i]);
  }
  if (lowest > slack || highest < -slack) return;

  double x[kMostCorners], y[kMostCorners];
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d q = vertices[i] - beams.middle.p;
    x[i] = beams.middle.R.col(0).dot(q);
    y[i] = beams.middle.R.col(1).dot(q);
  }
  double nearest = kInf;
  double low = 0.0, high = 0.0, bearing = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = i + 1 < n ? i + 1 : 0;
    nearest = std::min(nearest, distance_to_segment(x[i], y[i], x[k], y[k]));
    const double b = rough_atan2(y[i], x[i]);
    if (i == 0) {
      low = high = bearing = b;
      continue;
    }
    bearing += wrap_angle(b - bearing);
    low = std::min(low, bearing);
    high = std::max(high, bearing);
  }
  if (nearest > max_range + beams.travel) return;
  // How far the bearing of a point of the face can differ between its beam's pose and the middle one.
  const double tilt = std::max(std::abs(highest), std::abs(lowest));
  const double margin =
      nearest > 0.05 ? beams.turn * (1.0 + tilt / nearest) + beams.travel / nearest + 2.0 * kRoughAtan2Error : kPi;
  const double closed = bearing + wrap_angle(rough_atan2(y[0], x[0]) - bearing);
  const bool around = std::abs(closed - rough_atan2(y[0], x[0])) > 1.0;  // the laser's axis passes through the face
  if (around || margin >= kPi) {
    low = -kPi;
    high = kPi;
  } else {
    const double shift = low < -kPi ? 2.0 * kPi : 0.0;
    low += shift - margin;
    high += shift + margin;
  }
  spans(low, high, table, spans_);
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
  const double slack = beams.turn * (max_range + beams.travel) + beams.travel + 1e-4;
  const double height = beams.middle.R.col(2).dot(centre);
  if (std::abs(height) > sphere.radius + slack) return;
  const double flat = std::sqrt(std::max(0.0, distance * distance - height * height));
  const double clear = flat - sphere.radius - beams.travel;
  double low = -kPi;
  double high = kPi;
  if (clear > 0.05) {
    const double bearing = rough_atan2(beams.middle.R.col(1).dot(centre), beams.middle.R.col(0).dot(centre));
    const double margin = std::asin(sphere.radius / flat) +
                          beams.turn * (1.0 + (std::abs(height) + sphere.radius) / clear) + beams.travel / clear +
                          2.0 * kRoughAtan2Error;
    low = bearing - margin;
    high = bearing + margin;
  }
  spans(low, high, table, spans_);
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
