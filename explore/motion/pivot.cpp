#include "explore/motion/pivot.h"

#include <algorithm>
#include <cmath>

#include "base/planar.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kGain = 1.5;       ///< speed per distance from the spot [1/s]
constexpr double kFeeler = 0.10;    ///< clearance is compared so far ahead and behind [m]
constexpr double kLess = 0.05;      ///< with so much less than room the robot leaves at full speed [m]
constexpr double kAskew = 0.05;     ///< clearance that the way between the feelers gains, for it to lead to room [m]
constexpr double kCloserUp = 0.10;  ///< up there less room will do, for it does not stay [m]
constexpr double kLessUp = 0.25;    ///< of the way up, where there is no room for all of it
constexpr double kSlides = 0.03;    ///< a slope that carries it farther than this counts [m]
constexpr double kBelow = 0.04;     ///< so far below, with the way up ahead or behind, ... [m]
constexpr double kUnhurried = 0.5;  ///< ... it turns no faster than this [rad/s]
constexpr double kSlow = 0.2;       ///< turns as long as the robot drives towards room [rad/s]

}  // namespace

robot::Drive Pivot::keep(robot::Drive drive, const TPose2D& T_map_base, const Traversable& floor,
                         const TPoint2D& slides) {
  if (drive.v != 0.0 || drive.w == 0.0) {
    end();
    return drive;
  }
  const TPoint2D here = position(T_map_base);
  const TPoint2D ahead{std::cos(T_map_base.phi), std::sin(T_map_base.phi)};
  const auto clearance_at = [&](const TPoint2D& p) -> double {
    const Cell c = floor.clearance.cell(p);
    return floor.clearance.inside(c) && floor.cells[c] == Occupancy::Free ? floor.clearance[c] : 0.0;
  };
  const auto clearance = [&](double way) { return clearance_at(here + ahead * way); };
  if (floor.clearance.width() > 0 && clearance(0.0) < room_) {
    const double gain = std::clamp((room_ - clearance(0.0)) / kLess, 0.0, 1.0);
    const double there = clearance(kFeeler), back = clearance(-kFeeler);
    if (there != back && std::max(there, back) > clearance(0.0)) {
      drive.v = (there > back ? kMostSpeed : -kMostSpeed) * gain;
      // Room first: a corner that turns on reaches the wall before the robot has left it.
      if (std::abs(there - back) >= kAskew) drive.w += gain * (std::clamp(drive.w, -kSlow, kSlow) - drive.w);
    }
    spot_ = here;
    return drive;
  }
  if (!spot_) spot_ = here;
  // What it will slide down it stands higher, as far as there is room for that.
  const TPoint2D up = here - T_map_base.composePoint(slides);
  double share = 1.0;
  while (share > 0.0 && floor.clearance.width() > 0 && clearance_at(*spot_ + up * share) < room_ - kCloserUp)
    share -= kLessUp;
  const TPoint2D off = *spot_ + up * std::max(0.0, share) - here;
  const double way = off.x * ahead.x + off.y * ahead.y;
  drive.v = std::clamp(kGain * way, -kMostSpeed, kMostSpeed);
  // While it looks along the slope there is time to drive up.
  if (length(up) > kSlides && std::abs(way) > kBelow) drive.w = std::clamp(drive.w, -kUnhurried, kUnhurried);
  return drive;
}

}  // namespace rubble::explore
