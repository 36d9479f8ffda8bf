#pragma once

#include <algorithm>

namespace rubble::robot {

/// A speed on its way to another one, changed by at most `most`.
inline double approach(double from, double to, double most) { return from + std::clamp(to - from, -most, most); }

/// Speed set point of the body.
struct Drive {
  double v = 0.0;  ///< forward [m/s]
  double w = 0.0;  ///< counter-clockwise [rad/s]
};

/// Angles the servos shall hold the laser at, relative to the robot.
struct LaserAim {
  double pitch = 0.0;  ///< nose-up positive [rad]
  double roll = 0.0;   ///< left side up positive [rad]
};

/// Holds until replaced; a robot stops its motors when no command came for RobotModel::command_timeout.
struct Commands {
  Drive drive;
  LaserAim aim;
  /// Stop as hard as the base can, whatever ramp it keeps otherwise, its motors staying on. Goes with a drive of zero.
  bool brake = false;
};

}  // namespace rubble::robot
