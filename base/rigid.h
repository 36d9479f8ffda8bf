#pragma once

#include <mrpt/math/TPose2D.h>

#include <cmath>
#include <vector>

namespace rubble {

/// A pose with its cosine and sine at hand: TPose2D works them out anew for each point.
class Rigid {
 public:
  Rigid() = default;
  explicit Rigid(const mrpt::math::TPose2D& T) : T_(T), c_(std::cos(T.phi)), s_(std::sin(T.phi)) {}

  const mrpt::math::TPose2D& pose() const { return T_; }
  double c() const { return c_; }
  double s() const { return s_; }
  mrpt::math::TPoint2D forward(const mrpt::math::TPoint2D& p) const {
    return {c_ * p.x - s_ * p.y + T_.x, s_ * p.x + c_ * p.y + T_.y};
  }
  mrpt::math::TPoint2D inverse(const mrpt::math::TPoint2D& p) const {
    const double dx = p.x - T_.x;
    const double dy = p.y - T_.y;
    return {c_ * dx + s_ * dy, c_ * dy - s_ * dx};
  }
  /// A direction of the target frame in the source frame.
  mrpt::math::TPoint2D turned_back(double gx, double gy) const { return {c_ * gx + s_ * gy, c_ * gy - s_ * gx}; }

 private:
  mrpt::math::TPose2D T_;
  double c_ = 1.0;
  double s_ = 0.0;
};

/// The rotation by phi that takes `from` to `to`.
mrpt::math::TPose2D turned_onto(const mrpt::math::TPoint2D& from, const mrpt::math::TPoint2D& to, double phi);

/// The rotation and shift, scale 1, that takes the points `from` closest to the points `to` in the mean square; the
/// least squares of section IV.F (Arun 1987 in the plane). At least one pair.
mrpt::math::TPose2D fit_rigid(const std::vector<mrpt::math::TPoint2D>& from,
                              const std::vector<mrpt::math::TPoint2D>& to);

/// Whether two poses take `centre` to places less than `shift` [m] apart and turn by less than `turn` [rad] otherwise.
bool same_pose(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b, const mrpt::math::TPoint2D& centre,
               double shift, double turn);

}  // namespace rubble
