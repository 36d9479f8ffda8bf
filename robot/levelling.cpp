#include "robot/levelling.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"

namespace rubble::robot {

Levelling::Levelling(const LevellingConfig& config, const RobotModel& model)
    : config_(config), mount_(model.accelerometer_mount), felt_(accelerometer_place(model)) {}

LaserAim Levelling::update(const Inputs& inputs) {
  if (!config_.on) return {};
  if (!servos_known_ && !inputs.aims.empty()) {  // start from where the servos stand: no jump
    pitch_.command = std::clamp(inputs.aims.back().pitch, -config_.max_angle, config_.max_angle);
    roll_.command = std::clamp(inputs.aims.back().roll, -config_.max_angle, config_.max_angle);
    servos_known_ = true;
  }
  for (const Odometry& odometry : inputs.odometry) felt_.follow(odometry);
  for (const Acceleration& acceleration : inputs.accelerations) follow(acceleration);
  return {pitch_.command, roll_.command};
}

void Levelling::follow(const Acceleration& acceleration) {
  const Tilt tilt = felt_.of(acceleration, config_.feed_forward);
  const double dt = last_ == Stamp::never() ? 0.0 : acceleration.stamp - last_;
  if (last_ != Stamp::never() && dt <= 0.0) return;  // not younger than the one before
  if (dt > kTiltSilence) pitch_.started = roll_.started = false;
  last_ = acceleration.stamp;
  pitch_.command = step(pitch_, tilt.pitch, dt);
  roll_.command = step(roll_, tilt.roll, dt);
}

/// One control step of an axis; returns the new command.
double Levelling::step(Axis& axis, double tilt, double dt) const {
  if (!axis.started) {
    axis.started = true;
    axis.filtered = tilt;
    axis.last_error = axis.older_error = -tilt;
    if (mount_ == AccelerometerMount::Platform) return axis.command;
  } else {
    axis.filtered += (1.0 - std::exp(-2.0 * kPi * config_.filter_hz * dt)) * (tilt - axis.filtered);
  }
  const double error = -axis.filtered;
  double wanted = axis.command;
  if (mount_ == AccelerometerMount::Body) {
    if (std::abs(error - axis.command) > config_.dead_zone) wanted = error;
  } else if (std::abs(error) > config_.dead_zone) {
    wanted += config_.kp * (error - axis.last_error) + config_.ki * error * dt;
    if (dt > 0.0) wanted += config_.kd * (error - 2.0 * axis.last_error + axis.older_error) / dt;
  }
  axis.older_error = axis.last_error;
  axis.last_error = error;
  const double most = config_.max_rate * dt;
  wanted = std::clamp(wanted, axis.command - most, axis.command + most);
  return std::clamp(wanted, -config_.max_angle, config_.max_angle);
}

}  // namespace rubble::robot
