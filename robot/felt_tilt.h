#pragma once

#include "robot/measurements.h"

namespace rubble::robot {

/// Without a sample for so long a sensor counts as silent, and what it said last as nothing [s].
inline constexpr double kTiltSilence = 0.5;

struct Tilt {
  double pitch = 0.0;  ///< nose-up positive [rad]
  double roll = 0.0;   ///< left side up positive [rad]
};

/// Reads the tilt out of what an accelerometer feels. It feels the robot's own motion as tilt, too: 0.3 m/s^2 forward
/// looks like 1.75 deg nose up. What the wheels say about it comes late by an odometry period, yet takes most of it
/// away.
class FeltTilt {
 public:
  /// The wheels' latest speeds.
  void follow(const Odometry& odometry);
  /// The tilt that a sample shows, less the wheels' share unless these are silent, or not `asked`.
  Tilt of(const Acceleration& acceleration, bool asked = true) const;

 private:
  Odometry last_{Stamp::never(), {}, 0.0, 0.0, false};
  double forward_ = 0.0;  ///< [m/s^2]
  double lateral_ = 0.0;  ///< [m/s^2]
};

}  // namespace rubble::robot
