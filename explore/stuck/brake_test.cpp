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

BrakeTest::Verdict BrakeTest::verdict(Stamp now) const {
  if (begun_ == Stamp::never() || now - begun_ < config_.time) return Verdict::Open;
  // Against the way its wheels turned.
  const double lost = speed_ > 0.0 ? -gained_ : gained_;
  return lost >= config_.share * std::abs(speed_) ? Verdict::Moved : Verdict::Stood;
}

}  // namespace rubble::explore
