#pragma once

#include <optional>

#include "base/stamp.h"
#include "robot/commands.h"
#include "robot/model.h"

namespace rubble::explore {

/// A turn on the spot to let the scanner see all around, or to face something.
class LookAround {
 public:
  explicit LookAround(const robot::RobotModel& model);

  /// Begins a turn by `angle` [rad].
  void begin(double angle, Stamp now);
  void end() { left_ = 0.0; }
  bool active() const { return left_ != 0.0; }
  /// [rad], signed; 0: none under way
  double left() const { return left_; }

  /// The command, by up to `turn_speed` [rad/s], for a robot that turned by `turned` [rad] since the last tick; nothing
  /// when the turn is done or takes too long.
  std::optional<robot::Drive> turn(double turned, double turn_speed, Stamp now);

 private:
  double turn_brake_;  ///< [rad/s^2]
  double left_ = 0.0;  ///< [rad], signed; 0: none under way
  Stamp until_ = Stamp::never();
};

}  // namespace rubble::explore
