#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cmath>

namespace rubble {

/// Length of the vector (x, y). Unlike std::hypot a few instructions, and the same bits from every C library; the
/// squares of lengths met here neither overflow nor vanish.
inline double length(double x, double y) { return std::sqrt(x * x + y * y); }
inline double length(const mrpt::math::TPoint2D& v) { return length(v.x, v.y); }
inline double distance(const mrpt::math::TPoint2D& a, const mrpt::math::TPoint2D& b) {
  return length(b.x - a.x, b.y - a.y);
}

/// A pose made ready to move many points: sine and cosine are computed once.
class PlanarTransform {
 public:
  explicit PlanarTransform(const mrpt::math::TPose2D& T)
      : cosine_(std::cos(T.phi)), sine_(std::sin(T.phi)), x_(T.x), y_(T.y) {}

  mrpt::math::TPoint2D operator()(const mrpt::math::TPoint2D& p) const {
    return {x_ + cosine_ * p.x - sine_ * p.y, y_ + sine_ * p.x + cosine_ * p.y};
  }

 private:
  double cosine_;
  double sine_;
  double x_;
  double y_;
};

}  // namespace rubble
