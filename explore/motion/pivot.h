#pragma once

#include <mrpt/math/TPoint2D.h>

#include <optional>

#include "explore/anchor.h"
#include "explore/plan/traversable.h"
#include "robot/commands.h"

namespace rubble::explore {

/// Keeps a turn on the spot on its spot, and its corners off the walls. A skid-steered robot that only turns its wheels
/// against each other wanders, 0.1 to 0.2 m in half a turn on a ramp or on paper; and where there is no room for its
/// corners, it drives towards room first and turns slowly meanwhile: a corner that turns on scrapes along the wall.
/// Beside a wall it has to turn until a way leads off it; between two walls there is no room to be had.
class Pivot {
 public:
  /// `room`: clearance of the robot's middle at which it can turn [m].
  explicit Pivot(double room) : room_(room) {}

  /// What the slope that the robot stands on does to it.
  struct Slope {
    mrpt::math::TPoint2D slides{0.0, 0.0};  ///< down it, as it turns across it [m/rad, base frame]
    double turn = 0.0;                      ///< that is left [rad]
  };
  /// The drive for a robot that was to be driven so. What is no turn on the spot is left as it is. On a slope it keeps
  /// as far up from its spot as it will slide in the rest of the turn, as long as its corners have room there.
  robot::Drive keep(robot::Drive drive, const Anchor& robot, const Traversable& floor, const Slope& slope);
  robot::Drive keep(robot::Drive drive, const Anchor& robot, const Traversable& floor) {
    return keep(drive, robot, floor, {});
  }

  /// The next turn has a spot of its own. So it has where the robot drove; where it only stood it turns on.
  void end() { spot_.reset(); }
  /// The mapper corrected its past.
  void follow(const slam::Mapper& mapper) {
    if (spot_) spot_->follow(mapper);
  }

  /// Drives that only turn, with what `keep` adds, are slower than this [m/s].
  static constexpr double kMostSpeed = 0.12;

 private:
  double room_;
  std::optional<AnchoredPoint> spot_;
};

}  // namespace rubble::explore
