#include "robot/felt_tilt.h"

#include <algorithm>
#include <cmath>

#include "robot/hardware_units.h"

namespace rubble::robot {

namespace {

double tilt_of(double specific_force, double gravity) {
  return std::asin(std::clamp(specific_force / gravity, -1.0, 1.0));
}

}  // namespace

WheelMotion wheel_motion(const Odometry& before, const Odometry& after, Stamp at) {
  WheelMotion motion{after.v, after.w, 0.0, 0.0};
  const double dt = after.stamp - before.stamp;
  if (dt <= 0.0 || dt > kTiltSilence) return motion;
  motion.acceleration = (after.v - before.v) / dt;
  motion.turn_acceleration = (after.w - before.w) / dt;
  const double left = std::max(0.0, after.stamp - at);
  motion.v -= left * motion.acceleration;
  motion.w -= left * motion.turn_acceleration;
  return motion;
}

mrpt::math::TPoint2D accelerometer_place(const RobotModel& model) {
  if (model.accelerometer_mount == AccelerometerMount::Body) return {0.0, 0.0};
  return {model.T_base_laser.x, model.T_base_laser.y};
}

Tilt felt_tilt(const Acceleration& acceleration, const mrpt::math::TPoint2D& place, const WheelMotion& motion) {
  const double inwards = motion.w * motion.w;
  const double forward = motion.acceleration - motion.turn_acceleration * place.y - inwards * place.x;
  const double sideways = motion.v * motion.w + motion.turn_acceleration * place.x - inwards * place.y;
  const double pitch = tilt_of(acceleration.x - forward, kGravity);
  const double roll = tilt_of(acceleration.y - sideways, kGravity * std::max(0.1, std::cos(pitch)));
  return {pitch, roll};
}

void FeltTilt::follow(const Odometry& odometry) {
  motion_ = last_.stamp == Stamp::never() ? WheelMotion{odometry.v, odometry.w, 0.0, 0.0}
                                          : wheel_motion(last_, odometry, odometry.stamp);
  last_ = odometry;
}

Tilt FeltTilt::of(const Acceleration& acceleration, bool asked) const {
  const bool known = asked && last_.stamp != Stamp::never() && acceleration.stamp - last_.stamp <= kTiltSilence;
  return felt_tilt(acceleration, place_, known ? motion_ : WheelMotion{});
}

}  // namespace rubble::robot
