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

void FeltTilt::follow(const Odometry& odometry) {
  const double dt = last_.stamp == Stamp::never() ? 0.0 : odometry.stamp - last_.stamp;
  forward_ = dt > 0.0 && dt <= kTiltSilence ? (odometry.v - last_.v) / dt : 0.0;
  lateral_ = odometry.v * odometry.w;
  last_ = odometry;
}

Tilt FeltTilt::of(const Acceleration& acceleration, bool asked) const {
  const bool known = asked && last_.stamp != Stamp::never() && acceleration.stamp - last_.stamp <= kTiltSilence;
  const double pitch = tilt_of(acceleration.x - (known ? forward_ : 0.0), kGravity);
  const double roll = tilt_of(acceleration.y - (known ? lateral_ : 0.0), kGravity * std::max(0.1, std::cos(pitch)));
  return {pitch, roll};
}

}  // namespace rubble::robot
