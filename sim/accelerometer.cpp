#include "sim/accelerometer.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "robot/felt_tilt.h"
#include "robot/hardware_units.h"
#include "sim/laser/rays.h"

namespace rubble::sim {
namespace {

using Eigen::Vector3d;

}  // namespace

Accelerometer::Accelerometer(const robot::RobotModel& model, const AccelerometerParameters& parameters, double noise,
                             std::uint64_t seed)
    : model_(model), parameters_(parameters), noise_(noise), rng_(seed, "acceleration") {
  for (Axis& axis : axes_) {
    const double zero = rng_.gaussian(parameters.zero_duty_spread);
    const double sensitivity = rng_.gaussian(parameters.sensitivity_spread);
    const double zero_error = rng_.gaussian(parameters.zero_residual);
    const double scale_error = rng_.gaussian(parameters.scale_residual);
    axis.sensitivity = 0.125 + std::clamp(sensitivity, -0.025, 0.025);
    axis.zero = 0.5 + std::clamp(zero, -0.15, 0.15);
    axis.calibrated_sensitivity = axis.sensitivity * (1.0 + noise * scale_error);
    axis.calibrated_zero = axis.zero + noise * zero_error * axis.sensitivity;
  }
}

/// In the sensor's axes [m/s^2]. The mount point's acceleration is the base's, from velocities, plus that of the lever
/// arm, from its last three positions: centripetal, tangential and the platform's own motion together.
Vector3d Accelerometer::specific_force(const WorldState& state, double dt) {
  const Placement base = base_placement(state);
  const bool on_platform = model_.accelerometer_mount == robot::AccelerometerMount::Platform;
  const mrpt::math::TPoint2D place = robot::accelerometer_place(model_);
  const Vector3d lever = base.R * Vector3d(place.x, place.y, model_.T_base_laser.z);
  Eigen::Matrix3d R = base.R;
  if (on_platform) R = base.R * rotation(0.0, state.aim.pitch, state.aim.roll);
  Vector3d acceleration = Vector3d::Zero();
  if (history_ > 0) {
    acceleration.x() = (state.velocity.x - velocity_.x) / dt;
    acceleration.y() = (state.velocity.y - velocity_.y) / dt;
  }
  if (history_ > 1) {
    acceleration += (lever - 2.0 * lever_[0] + lever_[1]) / (dt * dt);
    acceleration.z() += (state.stance.z - 2.0 * height_[0] + height_[1]) / (dt * dt);
  }
  lever_[1] = lever_[0];
  lever_[0] = lever;
  height_[1] = height_[0];
  height_[0] = state.stance.z;
  velocity_ = state.velocity;
  history_ = std::min(2, history_ + 1);
  return R.transpose() * (acceleration + Vector3d(0.0, 0.0, robot::kGravity));
}

void Accelerometer::step(const WorldState& state, double dt) {
  const bool first = history_ == 0;
  const Vector3d force = specific_force(state, dt);
  if (dt != dt_) {
    dt_ = dt;
    blend_ = 1.0 - std::exp(-2.0 * kPi * parameters_.bandwidth_hz * dt);
  }
  const double blend = first ? 1.0 : blend_;
  // A single pole's noise bandwidth is 1.57 times its corner.
  const double sigma = noise_ * parameters_.noise_density * std::sqrt(1.57 * parameters_.bandwidth_hz);
  for (std::size_t i = 0; i < 2; ++i) {
    Axis& axis = axes_[i];
    axis.filtered += blend * (force[static_cast<Eigen::Index>(i)] / robot::kGravity - axis.filtered);
    const double noise = rng_.gaussian(sigma);
    const double duty = std::clamp(axis.zero + axis.sensitivity * (axis.filtered + noise), 0.0, 1.0);
    axis.t1 += std::llround(duty * parameters_.period_ticks);
  }
  t2_ += std::llround(parameters_.period_ticks);
}

robot::Acceleration Accelerometer::sample(Stamp stamp) {
  robot::Acceleration acceleration{stamp, 0.0, 0.0};
  double* values[2] = {&acceleration.x, &acceleration.y};
  for (std::size_t i = 0; i < 2; ++i) {
    Axis& axis = axes_[i];
    const double duty = t2_ > 0 ? static_cast<double>(axis.t1) / static_cast<double>(t2_) : axis.calibrated_zero;
    *values[i] = robot::kGravity * (duty - axis.calibrated_zero) / axis.calibrated_sensitivity;
    axis.t1 = 0;
  }
  t2_ = 0;
  return acceleration;
}

}  // namespace rubble::sim
