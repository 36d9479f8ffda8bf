#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>

#include "base/stamp.h"
#include "explore/plan/traversable.h"
#include "robot/commands.h"
#include "robot/model.h"

namespace rubble::explore {

/// A skid-steered robot in a curve on loose paper: the outer wheels spin on the paper, a slow inner one that grips holds
/// it, and it neither turns nor goes on. Nothing is in its way: with all wheels alike it drives on and off the paper.
class StraightOn {
 public:
  explicit StraightOn(const robot::RobotModel& model) : model_(model) {}

  /// Whether a robot that does not move as `commanded` is held so, by what its wheels do.
  bool explains(const robot::Drive& commanded, const std::optional<robot::Drive>& wheels) const;
  /// Whether to try it from here: not within a minute of the last time in the same place, and there is room.
  bool worth(const mrpt::math::TPose2D& T_map_base, const Traversable& floor, Stamp now) const;
  void begin(const mrpt::math::TPose2D& T_map_base, Stamp now);
  /// The command for the tick to come; nothing: it is over.
  std::optional<robot::Drive> drive(const mrpt::math::TPose2D& T_map_base, const Traversable& floor, Stamp now) const;

 private:
  bool room(const mrpt::math::TPose2D& T_map_base, const Traversable& floor) const;

  robot::RobotModel model_;
  mrpt::math::TPose2D from_;
  Stamp began_ = Stamp::never();
};

}  // namespace rubble::explore
