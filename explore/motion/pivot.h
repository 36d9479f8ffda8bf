#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <optional>

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

  /// The drive for a robot at T_map_base that was to be driven so. What is no turn on the spot is left as it is.
  /// `slides`: how far the slope it stands on will carry it in the rest of the turn [m, base frame]; it keeps so far up
  /// from its spot, as long as its corners have room there.
  robot::Drive keep(robot::Drive drive, const mrpt::math::TPose2D& T_map_base, const Traversable& floor,
                    const mrpt::math::TPoint2D& slides = {0.0, 0.0});

  /// The turn is over, or the map has moved: the next one has a spot of its own.
  void end() { spot_.reset(); }

  /// Drives that only turn, with what `keep` adds, are slower than this [m/s].
  static constexpr double kMostSpeed = 0.12;

 private:
  double room_;
  std::optional<mrpt::math::TPoint2D> spot_;
};

}  // namespace rubble::explore
