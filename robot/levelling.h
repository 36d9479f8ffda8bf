#pragma once

#include "base/angle.h"
#include "robot/commands.h"
#include "robot/felt_tilt.h"
#include "robot/measurements.h"
#include "robot/model.h"

namespace rubble::robot {

struct LevellingConfig {
  bool on = true;                       ///< off: the laser stays fixed to the robot
  double kp = 0.3;                      ///< proportional gain
  double ki = 4.0;                      ///< integral gain [1/s]
  double kd = 0.0;                      ///< derivative gain [s]
  double filter_hz = 5.0;               ///< low pass on the measured tilt
  double max_rate = deg_to_rad(120.0);  ///< slew limit of the command [rad/s]
  double max_angle = deg_to_rad(30.0);  ///< servo travel [rad]
  double dead_zone = deg_to_rad(0.3);   ///< errors below are left alone [rad]
  bool feed_forward = true;             ///< take the wheels' own acceleration out of the measured specific force
};

/// PID on the two-axis accelerometer that keeps the laser's scan plane level (paper, section III.C).
/// Platform: incremental PI(D), du = kp (e - e') + ki e dt + kd (e - 2 e' + e'') / dt with e the negative low-passed
/// tilt; clamping u is the anti-windup. Body: u is the negative low-passed tilt.
class Levelling {
 public:
  Levelling(const LevellingConfig& config, const RobotModel& model);
  ~Levelling() = default;

  /// Digests the tick's accelerations, odometry and servo angles; returns the angles the servos shall take.
  LaserAim update(const Inputs& inputs);

 private:
  struct Axis {
    double filtered = 0.0;
    double last_error = 0.0;
    double older_error = 0.0;
    double command = 0.0;
    bool started = false;  ///< the filter holds a value
  };

  void follow(const Acceleration& acceleration);
  double step(Axis& axis, double tilt, double dt) const;

  LevellingConfig config_;
  AccelerometerMount mount_;
  Axis pitch_;
  Axis roll_;
  Stamp last_ = Stamp::never();
  FeltTilt felt_;
  bool servos_known_ = false;
};

}  // namespace rubble::robot
