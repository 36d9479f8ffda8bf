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
constexpr double kCloserUp = 0.10;  ///< to a wall above less room will do: a slope carries it off that one, ... [m]
constexpr double kNoCloser = 0.06;  ///< ... but so much less it does not look for: the map's cells are coarse [m]
constexpr double kLessUp = 0.25;    ///< of the way up, where there is no room for all of it
constexpr double kIsSlope = 0.05;   ///< what carries it farther than this counts, as one of 4.5 deg does [m/rad]
constexpr double kSlidesOn = 0.6;   ///< of a turn, in which it is carried away unanswered, at most [rad]
constexpr double kBelow = 0.04;     ///< so far below, with the way up ahead or behind, ... [m]
constexpr double kUnhurried = 0.5;  ///< ... it turns no faster than this [rad/s]
constexpr double kSlow = 0.2;       ///< turns as long as the robot drives towards room [rad/s]

}  // namespace

robot::Drive Pivot::keep(robot::Drive drive, const Anchor& robot, const Traversable& floor, const Slope& slope) {
  if (drive.v != 0.0) end();
  if (drive.v != 0.0 || drive.w == 0.0) return drive;
  const TPose2D& T_map_base = robot.T_map_base;
  const TPoint2D here = position(T_map_base);
  const TPoint2D ahead{std::cos(T_map_base.phi), std::sin(T_map_base.phi)};
  const bool mapped = floor.clearance.width() > 0;
  const auto clearance_at = [&](const TPoint2D& p) -> double {
    const Cell c = floor.clearance.cell(p);
    return floor.clearance.inside(c) && floor.cells[c] == Occupancy::Free ? floor.clearance[c] : 0.0;
  };
  const bool slides = length(slope.slides) > kIsSlope;
  const TPoint2D down = slides ? T_map_base.composePoint(slope.slides) - here : TPoint2D{0.0, 0.0};  // [m/rad]
  const auto along = [&](const TPoint2D& way) { return way.x * ahead.x + way.y * ahead.y; };
  if (mapped) {
    const double now = clearance_at(here), there = clearance_at(here + ahead * kFeeler),
                 back = clearance_at(here - ahead * kFeeler);
    const double sense = there > back ? 1.0 : -1.0;
    const bool leads_down = there != back && sense * along(down) > 0.0;
    const double room = leads_down ? room_ - kCloserUp : room_;
    if (now < room) {
      const double gain = std::clamp((room - now) / kLess, 0.0, 1.0);
      if (there != back && std::max(there, back) > now) {
        drive.v = sense * kMostSpeed * gain;
        // Room first: a corner that turns on reaches the wall before the robot has left it.
        if (std::abs(there - back) >= kAskew) drive.w += gain * (std::clamp(drive.w, -kSlow, kSlow) - drive.w);
      }
      if (!spot_ || clearance_at(spot_->p_map()) <= now) spot_.emplace(robot, here);
      return drive;
    }
  }
  if (!spot_) spot_.emplace(robot, here);
  // What it will slide down it stands higher, as far as there is room for that.
  const TPoint2D spot = spot_->p_map(), up = down * -std::min(kSlidesOn, slope.turn);
  double share = 1.0;
  while (share > 0.0 && mapped && clearance_at(spot + up * share) < room_ - kNoCloser) share -= kLessUp;
  const double way = along(spot + up * std::max(0.0, share) - here);
  drive.v = std::clamp(kGain * way, -kMostSpeed, kMostSpeed);
  // While it looks along the slope there is time to drive up.
  if (slides && std::abs(way) > kBelow) drive.w = std::clamp(drive.w, -kUnhurried, kUnhurried);
  return drive;
}

}  // namespace rubble::explore
