#pragma once

#include <optional>

#include "base/stamp.h"
#include "robot/commands.h"

namespace rubble::explore {

/// A short way back, or a short turn where there is no room behind, to get free of what holds the robot.
class BackingUp {
 public:
  /// `turn_rate` [rad/s], signed: turns instead of driving back; 0: drives back.
  void begin(double turn_rate, Stamp now);
  /// The command; nothing when the time is over.
  std::optional<robot::Drive> drive(Stamp now) const;

 private:
  double turn_rate_ = 0.0;
  Stamp until_ = Stamp::never();
};

}  // namespace rubble::explore
