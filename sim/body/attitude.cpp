#include "sim/body/attitude.h"

#include <cmath>

namespace rubble::sim {
namespace {

constexpr double kTyreTime = 0.03;  ///< [s]

}  // namespace

Stance stance_on(const std::array<Ground, 4>& ground, const robot::RobotModel& model) {
  const double front = 0.5 * (ground[0].height + ground[2].height);
  const double rear = 0.5 * (ground[1].height + ground[3].height);
  const double left = 0.5 * (ground[0].height + ground[1].height);
  const double right = 0.5 * (ground[2].height + ground[3].height);
  Stance stance;
  stance.z = 0.5 * (front + rear);
  stance.pitch = std::atan((front - rear) / model.wheelbase);
  // The left axis is level with the plane's slope across it only after the pitch has been taken out.
  stance.roll = std::atan((left - right) / model.track * std::cos(stance.pitch));
  return stance;
}

void Attitude::step(const Stance& resting, double dt) {
  const double blend = dt / (kTyreTime + dt);
  stance_.z += blend * (resting.z - stance_.z);
  stance_.pitch += blend * (resting.pitch - stance_.pitch);
  stance_.roll += blend * (resting.roll - stance_.roll);
}

}  // namespace rubble::sim
