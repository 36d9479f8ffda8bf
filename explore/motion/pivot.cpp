#include "explore/motion/pivot.h"

#include <algorithm>
#include <cmath>

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kGain = 1.5;     ///< speed per distance from the spot [1/s]
constexpr double kFeeler = 0.10;  ///< clearance is compared so far ahead and behind [m]
constexpr double kLess = 0.05;    ///< with so much less than room the robot leaves at full speed [m]
constexpr double kAskew = 0.05;   ///< clearance that the way between the feelers gains, for it to lead to room [m]
constexpr double kSlow = 0.2;     ///< turns as long as the robot drives towards room [rad/s]

}  // namespace

robot::Drive Pivot::keep(robot::Drive drive, const TPose2D& T_map_base, const Traversable& floor) {
  if (drive.v != 0.0 || drive.w == 0.0) {
    spot_.reset();
    return drive;
  }
  const TPoint2D here{T_map_base.x, T_map_base.y};
  const TPoint2D ahead{std::cos(T_map_base.phi), std::sin(T_map_base.phi)};
  const auto clearance = [&](double way) -> double {
    const Cell c = floor.clearance.cell(here + ahead * way);
    return floor.clearance.inside(c) && floor.cells[c] == Occupancy::Free ? floor.clearance[c] : 0.0;
  };
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
  const TPoint2D off = *spot_ - here;
  drive.v = std::clamp(kGain * (off.x * ahead.x + off.y * ahead.y), -kMostSpeed, kMostSpeed);
  return drive;
}

}  // namespace rubble::explore
