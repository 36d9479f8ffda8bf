#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>

#include "base/stamp.h"
#include "explore/anchor.h"
#include "explore/caution/trail.h"
#include "explore/plan/traversable.h"
#include "explore/stuck/escape.h"
#include "explore/stuck/stuck_watch.h"
#include "explore/stuck/way_back.h"
#include "robot/commands.h"
#include "robot/model.h"
#include "slam/mapper.h"

namespace rubble::explore {

/// Gets a robot free that is held, and keeps account of it: where that was, how often in the same place, and how many
/// escapes failed in a row. Each failure lets the next escape turn by other angles, and the way in pose by pose is
/// tried sooner; ten in a row are the end.
class Recovery {
 public:
  enum class Result { UnderWay, Free, Failed, Stuck };

  explicit Recovery(const robot::RobotModel& model, double turn_speed) : model_(model), escape_(turn_speed) {}

  /// Takes in where the robot is, in every tick.
  void moved(Stamp now, const mrpt::math::TPose2D& T_map_base) { way_back_.add(now, T_map_base); }
  /// The mapper corrected its past.
  void follow(const slam::Mapper& mapper) {
    way_back_.follow(mapper);
    escape_.follow(mapper);
    if (place_) place_->follow(mapper);
  }

  /// Something was met and holds the robot, which is to go the `way_out` where that is in a trap. Says whether the
  /// same place held it the last time as well.
  bool begin(Escape::Met met, const mrpt::math::TPose2D& T_map_base, Stamp now,
             std::optional<WayOut> way_out = std::nullopt);
  /// One tick of `dt` [s] under the command that was in force. Stuck: everything was tried again and again.
  Result step(const mrpt::math::TPose2D& T_map_base, const robot::Drive& commanded, const StuckWatch& watch, double dt,
              Stamp now, const Trail& trail, const Traversable& floor);
  /// The command for the tick to come.
  const robot::Drive& drive() const { return escape_.drive(); }
  /// Something was met in this tick: the base shall not push on.
  bool met() const { return escape_.met(); }

  /// It moves, but comes away no farther than a trap lets it.
  bool caught() const { return escape_.roamed() > kRoams; }

  /// How often the robot was held so far.
  int times() const { return times_; }

 private:
  static constexpr double kRoams = 0.1;  ///< a robot that is held fast moves less [m]

  double gap_to_walls(const mrpt::math::TPose2D& pose, const Traversable& floor) const;

  robot::RobotModel model_;
  Escape escape_;
  WayBack way_back_;
  std::optional<AnchoredPoint> place_;  ///< where it was held last
  int times_ = 0;
  int failed_ = 0;  ///< in a row
};

}  // namespace rubble::explore
