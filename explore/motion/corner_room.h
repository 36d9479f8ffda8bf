#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <optional>
#include <vector>

#include "explore/anchor.h"
#include "explore/plan/traversable.h"
#include "robot/commands.h"
#include "robot/model.h"

namespace rubble::explore {

/// Keeps the corners of a body that turns on the spot off the walls. The clearance of its middle knows of a circle;
/// here the shape of the body is moved ahead in time, and where a corner would come too near to a wall the robot turns
/// more slowly, drives a little to or fro as it turns, or drives off the wall before it turns on. A base on its ramp
/// rolls on for 0.6 m from full speed; where it would turn into a wall meanwhile it brakes.
class CornerRoom {
 public:
  explicit CornerRoom(const robot::RobotModel& model) : model_(model) {}

  struct Kept {
    robot::Drive drive;
    bool brakes = false;  ///< as hard as the base can
  };
  /// The drive for a robot that is to turn on the spot, or nearly, by `drive`. `moving`: what its wheels do; `hits`: of
  /// the newest scan [m, map frame], which show the ends of walls more sharply than the map.
  Kept keep(const robot::Drive& drive, const robot::Drive& moving, const Anchor& robot, const Traversable& floor,
            const std::vector<mrpt::math::TPoint2D>& hits);
  /// It does not turn on the spot now.
  void end() { spot_.reset(); }
  /// The mapper corrected its past.
  void follow(const slam::Mapper& mapper) {
    if (spot_) spot_->follow(mapper);
  }

 private:
  struct Wall {
    mrpt::math::TPoint2D at;  ///< [m, base frame]
    double radius;            ///< [m]
  };

  void find_walls(const mrpt::math::TPose2D& T_map_base, const Traversable& floor,
                  const std::vector<mrpt::math::TPoint2D>& hits);
  bool seen(const mrpt::math::TPose2D& T_map_base, const Traversable& floor, double way) const;
  double gap(const mrpt::math::TPose2D& T_base_then) const;
  double least_gap(const robot::Drive& drive) const;

  robot::RobotModel model_;
  robot::Drive moving_;
  std::optional<AnchoredPoint> spot_;  ///< where the turn began
  double to_or_fro_ = 0.0;             ///< sign of the speed chosen last
  std::vector<Wall> walls_;            ///< about the robot
};

}  // namespace rubble::explore
