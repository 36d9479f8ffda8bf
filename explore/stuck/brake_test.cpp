#include "explore/stuck/brake_test.h"

#include <cmath>
#include <optional>

namespace rubble::explore {

void BrakeTest::update(const robot::Inputs& inputs) {
  for (const robot::Acceleration& sample : inputs.accelerations) {
    const bool brakes = under_way(sample.stamp);
    const std::optional<double> dt = rest_.update(sample, !brakes);
    if (brakes && dt) gained_ += rest_.felt() * *dt;
  }
}

/// What was felt before the robot braked and is told late is none of the test.
bool BrakeTest::under_way(Stamp stamp) const {
  return begun_ != Stamp::never() && stamp > begun_ && stamp - begun_ <= config_.time;
}

bool BrakeTest::can_tell(double speed, Stamp now) const {
  return std::abs(speed) >= config_.slowest && rest_.last() != Stamp::never() &&
         now - rest_.last() <= Rest::kLongestGap;
}

void BrakeTest::begin(double speed, Stamp now) {
  speed_ = speed;
  gained_ = 0.0;
  begun_ = now;
}

double BrakeTest::lost_share() const {
  // Against the way its wheels turned.
  return speed_ == 0.0 ? 0.0 : -gained_ / speed_;
}

BrakeTest::Verdict BrakeTest::verdict(Stamp now) const {
  if (begun_ == Stamp::never() || now - begun_ < config_.time) return Verdict::Open;
  return lost_share() >= config_.share ? Verdict::Moved : Verdict::Stood;
}

}  // namespace rubble::explore
