#pragma once

#include <mrpt/math/TPose2D.h>

#include "base/angle.h"
#include "robot/commands.h"

namespace rubble::explore {

struct MotionWatchConfig {
  double moved = 0.06;              ///< this far from where the watch began, the robot moves [m]
  double turned = deg_to_rad(8.0);  ///< or turned this much [rad]
  double patience = 0.35;           ///< way commanded in vain that means stuck [m]
  double turn_patience = 1.6;       ///< turn commanded in vain that means stuck [rad]
  double stall_time = 0.3;          ///< the motors report a stall for this long [s]
};

/// Finds out that the robot is stuck: it is told to move, but its pose stays or its motors stall.
class MotionWatch {
 public:
  explicit MotionWatch(const MotionWatchConfig& config = {}) : config_(config) {}

  /// One tick of `dt` seconds under the command that was in force; true when the robot is stuck.
  bool stuck(const mrpt::math::TPose2D& T_map_base, const robot::Drive& commanded, bool stalled, double dt);
  /// Begins anew, e.g. after the robot freed itself.
  void reset();

 private:
  MotionWatchConfig config_;
  mrpt::math::TPose2D reference_;
  bool has_reference_ = false;
  double way_ = 0.0;
  double turn_ = 0.0;
  double stalled_for_ = 0.0;
};

}  // namespace rubble::explore
