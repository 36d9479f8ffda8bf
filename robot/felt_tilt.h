#pragma once

#include <mrpt/math/TPoint2D.h>

#include "robot/measurements.h"
#include "robot/model.h"
#include "robot/tilt.h"

namespace rubble::robot {

/// Without a sample for so long a sensor counts as silent, and what it said last as nothing [s].
inline constexpr double kTiltSilence = 0.5;

/// How the base moves, as its wheels say.
struct WheelMotion {
  double v = 0.0;                  ///< forward speed [m/s]
  double w = 0.0;                  ///< turn rate [rad/s]
  double acceleration = 0.0;       ///< of v [m/s^2]
  double turn_acceleration = 0.0;  ///< of w [rad/s^2]
};

/// What the wheels do between two odometries, at a stamp within or after them; without acceleration where these lie
/// more than kTiltSilence apart.
WheelMotion wheel_motion(const Odometry& before, const Odometry& after, Stamp at);

/// Where the accelerometer sits, from the turning centre of the base, when all is level [m].
mrpt::math::TPoint2D accelerometer_place(const RobotModel& model);

/// The tilt that an accelerometer at `place` shows on a base that moves. It feels motion as tilt, too: 0.3 m/s^2
/// forward looks like 1.75 deg nose up; 0.145 m ahead of the turning centre, 60 deg/s on the spot look like 0.9 deg
/// nose down. The acceleration at a place r of a rigid body is a + alpha x r + w x (w x r), and the centre's own is
/// (dv/dt, v w).
Tilt felt_tilt(const Acceleration& acceleration, const mrpt::math::TPoint2D& place, const WheelMotion& motion);

/// The same as measurements arrive. What the wheels say comes late by an odometry period, yet takes most of the motion
/// away.
class FeltTilt {
 public:
  explicit FeltTilt(const mrpt::math::TPoint2D& place) : place_(place) {}

  /// The wheels' latest speeds.
  void follow(const Odometry& odometry);
  /// The tilt that a sample shows, less the wheels' share unless these are silent, or not `asked`.
  Tilt of(const Acceleration& acceleration, bool asked = true) const;

 private:
  mrpt::math::TPoint2D place_;
  Odometry last_{Stamp::never(), {}, 0.0, 0.0, false};
  WheelMotion motion_;
};

}  // namespace rubble::robot
