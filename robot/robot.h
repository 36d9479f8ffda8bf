#pragma once

#include <optional>

#include "base/error.h"
#include "robot/commands.h"
#include "robot/measurements.h"
#include "robot/model.h"

namespace rubble::robot {

/// A device fell silent or was unplugged; what() names it and the remedy. Exit code 4.
class DeviceLost : public RunError {
 public:
  using RunError::RunError;
};

/// The one interface between the core and a robot: simulated, replayed or real, the core cannot tell which.
class Robot {
 public:
  virtual ~Robot() = default;
  /// Fixed for the run.
  virtual const RobotModel& model() const = 0;
  /// Waits for one tick and returns all that arrived in it; nothing when the run is over. Throws DeviceLost.
  virtual std::optional<Inputs> read() = 0;
  /// Holds until replaced; without any for model().command_timeout the motors stop.
  virtual void command(const Commands& commands) = 0;
};

}  // namespace rubble::robot
