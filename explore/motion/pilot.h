#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <vector>

#include "base/stamp.h"
#include "explore/motion/corner_room.h"
#include "explore/motion/look_around.h"
#include "explore/motion/path_watch.h"
#include "explore/motion/pivot.h"
#include "explore/plan/path_follower.h"
#include "explore/plan/planner.h"
#include "explore/plan/traversable.h"
#include "robot/commands.h"
#include "robot/model.h"
#include "robot/slope_creep.h"

namespace rubble::explore {

/// What a turn on the spot is made for: a look around, which a new way ends; a look around to its end; to face a place.
enum class TurnFor { View, WholeView, Place };

/// Carries out the motion under way, which is a turn on the spot, a path, or none: a turn goes before a path. Slows
/// down and waits for what the path is found to hold, and keeps turns on their spot.
class Pilot {
 public:
  Pilot(const robot::RobotModel& model, const FollowerConfig& config);

  /// Begins a turn by `angle` [rad], without a path.
  void turn(double angle, TurnFor purpose, Stamp now);
  void end_turn() { turn_.end(); }
  bool turning() const { return turn_.active(); }
  /// Drives along a plan's path from now on.
  void follow(Plan plan);
  /// Leaves the path; a turn goes on.
  void leave_path() { follower_.clear(); }
  void stop();

  /// Nothing is left of the path, or there is none.
  bool arrived() const { return follower_.arrived(); }
  /// Way left [m].
  double left() const { return follower_.left(); }
  const std::vector<PathPoint>& path() const { return follower_.path(); }

  struct Step {
    robot::Drive drive;       ///< for the tick to come
    bool brakes = false;      ///< stops as hard as the base can instead
    bool turn_ended = false;  ///< in this tick: done, or it took too long
    bool faced = false;       ///< likewise, of a turn to face a place
  };
  /// What a tick knows of the robot.
  struct Moment {
    mrpt::math::TPose2D T_map_base;
    double turned = 0.0;  ///< in this tick [rad]
    robot::Drive moving;  ///< what its wheels do
    robot::Tilt lean;     ///< of its body, where that is known now
    double slope = 0.0;   ///< of the floor, as it was known last [rad]
  };
  /// One tick; `hits`: of the newest scan [m, map frame].
  Step step(const Moment& robot, const Traversable& floor, const std::vector<mrpt::math::TPoint2D>& hits, Stamp now);

  /// Whether the path should be checked now; that then counts as done.
  bool check_due(Stamp now) { return watch_.due(now) && !arrived() && !turning(); }
  /// Holds the newest hits [m, map frame] against the path, at `speed` [m/s]. True when something new stands in it.
  bool check(const std::vector<mrpt::math::TPoint2D>& hits, const mrpt::math::TPose2D& T_map_base, double speed,
             Stamp now) {
    return watch_.check(follower_, hits, T_map_base, speed, d_min_, now);
  }
  /// What was found in the way and is not forgotten yet [m, map frame].
  std::vector<mrpt::math::TPoint2D> new_things(Stamp now) { return watch_.obstacles(now); }
  /// It waits for another way round what was found in this one.
  bool waits(Stamp now) const { return watch_.waits(now); }
  void forget_new_things() { watch_.forget(); }
  /// What was found last is not forgotten for `seconds`.
  void remember_new_things(double seconds, Stamp now) { watch_.remember(seconds, now); }
  /// The mapper corrected its past.
  void follow_map(const slam::Mapper& mapper) {
    watch_.follow(mapper);
    pivot_.follow(mapper);
    corners_.follow(mapper);
  }
  /// The map shows a way, the newest scans do not: go and see, slowly.
  void creep(Stamp now) { watch_.creep(now); }
  /// Something is being pushed.
  void slow_down(Stamp now) { watch_.slow_down(now); }

 private:
  void leave_spot() {
    pivot_.end();
    corners_.end();
  }
  CornerRoom::Kept kept(const robot::Drive& told, const Moment& robot, const Traversable& floor,
                        const std::vector<mrpt::math::TPoint2D>& hits, Stamp now);

  PathFollower follower_;
  PathWatch watch_;
  LookAround turn_;
  TurnFor purpose_ = TurnFor::View;
  Pivot pivot_;
  CornerRoom corners_;
  robot::SlopeCreep slides_;
  double d_min_ = 0.0;  ///< that the path keeps [m]
};

}  // namespace rubble::explore
