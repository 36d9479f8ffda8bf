#include "explore/paper/backing_up.h"

namespace rubble::explore {
namespace {

constexpr double kTime = 1.0;   ///< [s]
constexpr double kSpeed = 0.2;  ///< [m/s]

}  // namespace

void BackingUp::begin(double turn_rate, Stamp now) {
  turn_rate_ = turn_rate;
  until_ = now + kTime;
}

std::optional<robot::Drive> BackingUp::drive(Stamp now) const {
  if (now >= until_) return std::nullopt;
  return turn_rate_ != 0.0 ? robot::Drive{0.0, turn_rate_} : robot::Drive{-kSpeed, 0.0};
}

}  // namespace rubble::explore
