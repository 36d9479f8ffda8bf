#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <vector>

namespace rubble {

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
