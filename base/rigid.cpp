#include "base/rigid.h"

#include <cassert>
#include <cmath>

#include "base/angle.h"
#include "base/planar.h"

namespace rubble {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

TPose2D turned_onto(const TPoint2D& from, const TPoint2D& to, double phi) {
  const double c = std::cos(phi);
  const double s = std::sin(phi);
  return {to.x - (c * from.x - s * from.y), to.y - (s * from.x + c * from.y), phi};
}

TPose2D fit_rigid(const std::vector<TPoint2D>& from, const std::vector<TPoint2D>& to) {
  assert(!from.empty() && from.size() == to.size());
  const TPoint2D mean_from = middle_of(from);
  const TPoint2D mean_to = middle_of(to);
  double dot = 0.0;
  double cross = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const TPoint2D a = from[i] - mean_from;
    const TPoint2D b = to[i] - mean_to;
    dot += a.x * b.x + a.y * b.y;
    cross += a.x * b.y - a.y * b.x;
  }
  return turned_onto(mean_from, mean_to, std::atan2(cross, dot));
}

bool same_pose(const TPose2D& a, const TPose2D& b, const TPoint2D& centre, double shift, double turn) {
  return (a.composePoint(centre) - b.composePoint(centre)).norm() < shift && std::abs(wrap_angle(a.phi - b.phi)) < turn;
}

}  // namespace rubble
