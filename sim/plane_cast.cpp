#include "sim/plane_cast.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angle.h"
#include "sim/simd.h"

namespace rubble::sim {
namespace {

using Eigen::Vector3d;

constexpr double kSeam = 2e-5;  ///< segments reach so far beyond their ends: no light through seams [m]
constexpr float kInf = std::numeric_limits<float>::infinity();

}  // namespace

/// From (x0, y0) counter-clockwise to (x1, y1), seen from the origin over less than half a turn.
void PlaneCast::draw_segment(double x0, double y0, double x1, double y1, const BeamTable& table) {
  const double spread = x0 * y1 - x1 * y0;
  if (spread <= 1e-12) return;  // edge on
  const Float4 a = splat(static_cast<float>((y1 - y0) / spread));
  const Float4 b = splat(static_cast<float>((x0 - x1) / spread));
  const double low = rough_atan2(y0, x0) - kRoughAtan2Error - kSeam / std::max(kSeam, std::abs(x0) + std::abs(y0));
  double high = rough_atan2(y1, x1) + kRoughAtan2Error + kSeam / std::max(kSeam, std::abs(x1) + std::abs(y1));
  if (high < low) high += 2.0 * kPi;
  const Float4 fx0 = splat(static_cast<float>(x0)), fy0 = splat(static_cast<float>(y0));
  const Float4 fx1 = splat(static_cast<float>(x1)), fy1 = splat(static_cast<float>(y1));
  const Float4 outside = splat(static_cast<float>(-kSeam));
  for (const double shift : {0.0, -2.0 * kPi}) {  // the segment may lie across the seam behind
    const double first = std::max(0.0, std::ceil((low + shift - table.angle_min) / table.angle_step));
    const double last =
        std::min(static_cast<double>(table.count - 1), std::floor((high + shift - table.angle_min) / table.angle_step));
    if (first > last) continue;
    const std::size_t begin = static_cast<std::size_t>(first) / 4 * 4;
    const std::size_t end = static_cast<std::size_t>(last) + 1;
    for (std::size_t i = begin; i < end; i += 4) {
      const Float4 c = load4(&table.cosine[i]);
      const Float4 s = load4(&table.sine[i]);
      const Float4 best = load4(&inverse_[i]);
      const Float4 inverse = a * c + b * s;
      // Exactly between the two ends, whatever the rough bearings say.
      const Int4 hit = (fx0 * s - fy0 * c >= outside) & (fy1 * c - fx1 * s >= outside) & (inverse > best);
      store4(&inverse_[i], hit ? inverse : best);
    }
  }
}

void PlaneCast::draw(const ScanFaces::Polygon& polygon, const Placement& laser, const BeamTable& table) {
  const Vector3d* v = faces_.vertices(polygon);
  const Vector3d up = laser.R.col(2);
  const double offset = up.dot(laser.p);
  Vector3d ends[2];
  int found = 0;
  double z = up.dot(v[0]) - offset;
  const double z0 = z;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const std::size_t k = i + 1 < polygon.count ? i + 1 : 0;
    const double next = k > 0 ? up.dot(v[k]) - offset : z0;
    if ((z > 0.0) != (next > 0.0) && found < 2) ends[found++] = v[i] + z / (z - next) * (v[k] - v[i]);
    z = next;
  }
  if (found < 2) return;
  double x[2], y[2];
  for (int i = 0; i < 2; ++i) {
    const Vector3d q = ends[i] - laser.p;
    x[i] = laser.R.col(0).dot(q);
    y[i] = laser.R.col(1).dot(q);
  }
  if (x[0] * y[1] - x[1] * y[0] > 0.0) {
    draw_segment(x[0], y[0], x[1], y[1], table);
  } else {
    draw_segment(x[1], y[1], x[0], y[0], table);
  }
}

void PlaneCast::draw(const Sphere& sphere, const Placement& laser, const BeamTable& table, double max_range) {
  const Vector3d centre = Vector3d(sphere.x, sphere.y, sphere.z) - laser.p;
  const double height = laser.R.col(2).dot(centre);
  const double cut2 = sphere.radius * sphere.radius - height * height;
  if (cut2 <= 0.0) return;
  const double x = laser.R.col(0).dot(centre);
  const double y = laser.R.col(1).dot(centre);
  const double distance = std::sqrt(x * x + y * y);
  if (distance > max_range + sphere.radius || distance * distance <= cut2) return;
  const double half = std::asin(std::sqrt(cut2) / distance) + 2.0 * kRoughAtan2Error;
  const double bearing = rough_atan2(y, x);
  const Float4 cx = splat(static_cast<float>(x));
  const Float4 cy = splat(static_cast<float>(y));
  const Float4 r2 = splat(static_cast<float>(cut2));
  const Float4 zero = splat(0.0f);
  for (const double shift : {-2.0 * kPi, 0.0, 2.0 * kPi}) {
    const double first = std::max(0.0, std::floor((bearing + shift - half - table.angle_min) / table.angle_step));
    const double last = std::min(static_cast<double>(table.count - 1),
                                 std::ceil((bearing + shift + half - table.angle_min) / table.angle_step));
    if (first > last) continue;
    const std::size_t end = static_cast<std::size_t>(last) + 1;
    for (std::size_t i = static_cast<std::size_t>(first) / 4 * 4; i < end; i += 4) {
      const Float4 c = load4(&table.cosine[i]);
      const Float4 s = load4(&table.sine[i]);
      const Float4 along = cx * c + cy * s;
      const Float4 aside = cx * s - cy * c;
      const Float4 half2 = r2 - aside * aside;
      const Float4 best = load4(&inverse_[i]);
      const Float4 range = along - sqrt4(max4(half2, zero));
      const Float4 inverse = splat(1.0f) / range;
      const Int4 hit = (half2 >= zero) & (range > zero) & (inverse > best);
      store4(&inverse_[i], hit ? inverse : best);
    }
  }
}

void PlaneCast::cast(const Placement& laser, const BeamTable& table, double max_range,
                     const std::vector<Sphere>& spheres, std::vector<float>& ranges) {
  inverse_.assign(table.cosine.size(), 0.0f);
  faces_.near(laser.p, max_range, 1e-6, near_);
  for (const std::uint32_t i : near_) draw(faces_.polygon(i), laser, table);
  for (const Sphere& sphere : spheres) draw(sphere, laser, table, max_range);
  ranges.resize(table.count);
  const float longest = static_cast<float>(max_range);
  for (std::size_t i = 0; i < table.count; ++i) {
    const float range = 1.0f / inverse_[i];
    ranges[i] = range <= longest ? range : kInf;
  }
}

}  // namespace rubble::sim
