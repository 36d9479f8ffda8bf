#include "robot/slope_creep.h"

#include <algorithm>
#include <cmath>

#include "base/planar.h"

namespace rubble::robot {
namespace {

using mrpt::math::TPoint2D;

constexpr double kSkids = 1.1;     ///< wheels that slide turn so much farther than ones that roll round, at least
constexpr double kSteepest = 0.5;  ///< part of the friction up to which slopes count: the law is one of small ones

}  // namespace

SlopeCreep::SlopeCreep(const RobotModel& model, double friction) {
  if (!(friction > 0.0 && model.wheelbase > 0.0 && model.track > 0.0)) return;
  // Wheels that turn as the robot does, as those of two with castors, do not slip.
  if (model.effective_track < kSkids * model.track) return;
  steepest_ = kSteepest * friction;
  const double a = 0.5 * model.wheelbase;
  const double b = 0.5 * model.track;
  const double p = a / length(a, b);
  const double q = b / length(a, b);
  along_ = a / (friction * q * q * q);
  across_ = a / (friction * p * p * q);
}

double SlopeCreep::slope(double angle) const { return std::clamp(std::tan(angle), -steepest_, steepest_); }

TPoint2D SlopeCreep::expected(const Tilt& lean, double turn) const {
  return {-along_ * slope(lean.pitch) * std::abs(turn), -across_ * slope(lean.roll) * std::abs(turn)};
}

TPoint2D SlopeCreep::across(const Tilt& lean, double turn) const {
  return {-across_ * slope(lean.pitch) * std::abs(turn), -across_ * slope(lean.roll) * std::abs(turn)};
}

}  // namespace rubble::robot
