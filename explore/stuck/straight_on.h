#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <optional>
#include <vector>

#include "base/stamp.h"
#include "explore/anchor.h"
#include "explore/plan/traversable.h"
#include "explore/stuck/stuck_watch.h"
#include "robot/commands.h"
#include "robot/model.h"

namespace rubble::explore {

/// A skid-steered robot in a curve on loose paper: the outer wheels spin on the paper, a slow inner one that grips
/// holds it: it does not turn, and stands or creeps. Nothing is in its way: with all wheels alike it drives on and off
/// the paper.
class StraightOn {
 public:
  explicit StraightOn(const robot::RobotModel& model) : model_(model) {}

  /// Whether a robot that does not move as `commanded` is held so, by what its wheels do: its pose stands, or its
  /// heading alone stays while the pose creeps on; no blow, stall or slope tells of anything else.
  bool explains(const StuckWatch::Hold& hold, const robot::Drive& commanded,
                const std::optional<robot::Drive>& wheels) const;
  /// Whether to try it from here: not within a minute of another time in the same place, and there is room(). `hits`:
  /// of the newest scan [m, map frame].
  bool worth(const mrpt::math::TPose2D& T_map_base, const Traversable& floor,
             const std::vector<mrpt::math::TPoint2D>& hits, Stamp now) const;
  void begin(const mrpt::math::TPose2D& T_map_base, Stamp now);
  /// The command for the tick to come; nothing: it came on, or its time is over.
  std::optional<robot::Drive> drive(const mrpt::math::TPose2D& T_map_base, Stamp now) const;
  /// The mapper corrected its past.
  void follow(const slam::Mapper& mapper);
  /// Nothing is in the way before the robot, as far as it takes to stop: the floor is known and free, and no hit lies
  /// there.
  bool room(const mrpt::math::TPose2D& T_map_base, const Traversable& floor,
            const std::vector<mrpt::math::TPoint2D>& hits) const;

 private:
  struct Try {
    Stamp at;
    AnchoredPoint place;
  };

  double speed() const;

  robot::RobotModel model_;
  std::vector<Try> tries_;  ///< of the last minute
};

}  // namespace rubble::explore
