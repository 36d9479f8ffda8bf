#include "explore/motion/look_around.h"

#include <cmath>

#include "base/angle.h"
#include "explore/plan/path_follower.h"

namespace rubble::explore {
namespace {

constexpr double kTimeout = 12.0;          ///< [s]
constexpr double kDone = deg_to_rad(5.0);  ///< [rad]
constexpr double kShareOfTurnAccel = 0.6;  ///< counted on for braking

}  // namespace

LookAround::LookAround(const robot::RobotModel& model) : turn_brake_(kShareOfTurnAccel * model.max_turn_accel) {}

void LookAround::begin(double angle, Stamp now) {
  left_ = angle;
  until_ = now + kTimeout;
}

std::optional<robot::Drive> LookAround::turn(double turned, double turn_speed, Stamp now) {
  const bool was_positive = left_ > 0.0;
  left_ -= turned;
  if (was_positive != (left_ > 0.0) || std::abs(left_) < kDone || now >= until_) {
    end();
    return std::nullopt;
  }
  return turn_on_the_spot(left_, turn_speed, turn_brake_);
}

}  // namespace rubble::explore
