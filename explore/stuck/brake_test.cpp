#include "explore/stuck/brake_test.h"

#include <algorithm>
#include <cmath>

namespace rubble::explore {
namespace {

constexpr double kLongestGap = 0.1;  ///< between two samples; after a longer gap they do not belong together [s]

}  // namespace

void BrakeTest::update(const robot::Inputs& inputs) {
  for (const robot::Acceleration& sample : inputs.accelerations) {
    const double dt = last_ == Stamp::never() ? 0.0 : sample.stamp - last_;
    const bool follows = last_ != Stamp::never() && dt > 0.0 && dt <= kLongestGap;
    last_ = sample.stamp;
    if (under_way(sample.stamp))
      gained_ += follows ? (sample.x - rest_) * dt : 0.0;
    else
      rest_ = follows ? rest_ + std::min(1.0, dt / config_.settling) * (sample.x - rest_) : sample.x;
  }
}

/// What was felt before the robot braked and is told late is none of the test.
bool BrakeTest::under_way(Stamp stamp) const {
  return begun_ != Stamp::never() && stamp > begun_ && stamp - begun_ <= config_.time;
}

bool BrakeTest::can_tell(double speed, Stamp now) const {
  return std::abs(speed) >= config_.slowest && last_ != Stamp::never() && now - last_ <= kLongestGap;
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
