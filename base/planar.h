#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cmath>
#include <vector>

#include "base/angle.h"

namespace rubble {

/// Length of the vector (x, y). Unlike std::hypot a few instructions, and the same bits from every C library; the
/// squares of lengths met here neither overflow nor vanish.
inline double length(double x, double y) { return std::sqrt(x * x + y * y); }
inline double length(const mrpt::math::TPoint2D& v) { return length(v.x, v.y); }
inline double distance(const mrpt::math::TPoint2D& a, const mrpt::math::TPoint2D& b) {
  return length(b.x - a.x, b.y - a.y);
}

/// The middle of some points, one at least.
inline mrpt::math::TPoint2D middle_of(const std::vector<mrpt::math::TPoint2D>& points) {
  mrpt::math::TPoint2D sum(0.0, 0.0);
  for (const mrpt::math::TPoint2D& p : points) sum += p;
  return sum * (1.0 / static_cast<double>(points.size()));
}

/// Where a pose is.
inline mrpt::math::TPoint2D position(const mrpt::math::TPose2D& pose) { return {pose.x, pose.y}; }

/// Whether two poses are equal to the last bit (same_pose of base/rigid.h: as good as).
inline bool identical(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b) {
  return a.x == b.x && a.y == b.y && a.phi == b.phi;
}

/// The pose with its angle in (-pi, pi].
inline mrpt::math::TPose2D wrapped(const mrpt::math::TPose2D& pose) { return {pose.x, pose.y, wrap_angle(pose.phi)}; }

/// A pose made ready to move many points: sine and cosine are computed once.
class PlanarTransform {
 public:
  PlanarTransform() = default;
  explicit PlanarTransform(const mrpt::math::TPose2D& T) : T_(T), cosine_(std::cos(T.phi)), sine_(std::sin(T.phi)) {}

  const mrpt::math::TPose2D& pose() const { return T_; }
  double cosine() const { return cosine_; }
  double sine() const { return sine_; }
  mrpt::math::TPoint2D operator()(const mrpt::math::TPoint2D& p) const {
    return {T_.x + cosine_ * p.x - sine_ * p.y, T_.y + sine_ * p.x + cosine_ * p.y};
  }
  mrpt::math::TPoint2D inverse(const mrpt::math::TPoint2D& p) const { return turned_back(p.x - T_.x, p.y - T_.y); }
  /// A direction of the target frame in the source frame.
  mrpt::math::TPoint2D turned_back(double x, double y) const {
    return {cosine_ * x + sine_ * y, cosine_ * y - sine_ * x};
  }

 private:
  mrpt::math::TPose2D T_;
  double cosine_ = 1.0;
  double sine_ = 0.0;
};

}  // namespace rubble
