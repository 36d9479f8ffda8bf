#include "slam/robust/tracking/slope_creep.h"

#include <cmath>

#include "base/planar.h"

namespace rubble::slam {

SlopeCreep::SlopeCreep(const robot::RobotModel& model, double friction) {
  // Wheels that turn as the robot does, as those of two with castors, do not slip.
  if (friction <= 0.0 || model.effective_track <= model.track) return;
  const double a = 0.5 * model.wheelbase;
  const double b = 0.5 * model.track;
  const double p = a / length(a, b);
  const double q = b / length(a, b);
  along_ = a / (friction * q * q * q);
  across_ = a / (friction * p * p * q);
}

mrpt::math::TPoint2D SlopeCreep::expected(const ScanTilt& tilt, double turn) const {
  return {-along_ * std::tan(tilt.body_pitch) * std::abs(turn), -across_ * std::tan(tilt.body_roll) * std::abs(turn)};
}

}  // namespace rubble::slam
