#include "robot/levelling.h"

#include <algorithm>
#include <cmath>

#include "robot/hardware_units.h"

namespace rubble::robot {

namespace {

constexpr double kSilence = 0.5;  ///< after so long without a sample the sensor counts as lost [s]

double tilt_of(double specific_force, double gravity) {
  return std::asin(std::clamp(specific_force / gravity, -1.0, 1.0));
}

}  // namespace

Levelling::Levelling(const LevellingConfig& config, AccelerometerMount mount) : config_(config), mount_(mount) {}

LaserAim Levelling::update(const Inputs& inputs) {
  if (!config_.on) return {};
  if (!servos_known_ && !inputs.aims.empty()) {  // start from where the servos stand: no jump
    pitch_.command = std::clamp(inputs.aims.back().pitch, -config_.max_angle, config_.max_angle);
    roll_.command = std::clamp(inputs.aims.back().roll, -config_.max_angle, config_.max_angle);
    servos_known_ = true;
  }
  for (const Odometry& odometry : inputs.odometry) follow(odometry);
  for (const Acceleration& acceleration : inputs.accelerations) follow(acceleration);
  return {pitch_.command, roll_.command};
}

/// The sensor feels the robot's own motion as tilt: 0.3 m/s^2 forward looks like 1.75 deg nose up. What the wheels say
/// about it comes late by an odometry period, yet takes most of it away.
void Levelling::follow(const Odometry& odometry) {
  const double dt = last_odometry_.stamp == Stamp::never() ? 0.0 : odometry.stamp - last_odometry_.stamp;
  forward_acceleration_ = dt > 0.0 && dt <= kSilence ? (odometry.v - last_odometry_.v) / dt : 0.0;
  lateral_acceleration_ = odometry.v * odometry.w;
  last_odometry_ = odometry;
}

void Levelling::follow(const Acceleration& acceleration) {
  const bool known = config_.feed_forward && last_odometry_.stamp != Stamp::never() &&
                     acceleration.stamp - last_odometry_.stamp <= kSilence;
  const double x = acceleration.x - (known ? forward_acceleration_ : 0.0);
  const double y = acceleration.y - (known ? lateral_acceleration_ : 0.0);
  const double pitch = tilt_of(x, kGravity);
  const double roll = tilt_of(y, kGravity * std::max(0.1, std::cos(pitch)));

  const double dt = last_ == Stamp::never() ? 0.0 : acceleration.stamp - last_;
  if (last_ != Stamp::never() && dt <= 0.0) return;  // not younger than the one before
  if (dt > kSilence) pitch_.started = roll_.started = false;
  last_ = acceleration.stamp;
  pitch_.command = step(pitch_, pitch, dt);
  roll_.command = step(roll_, roll, dt);
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
