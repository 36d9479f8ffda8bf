#include "explore/stuck/rest.h"

#include <algorithm>

namespace rubble::explore {

std::optional<double> Rest::update(const robot::Acceleration& sample, bool learn) {
  const double dt = last_ == Stamp::never() ? 0.0 : sample.stamp - last_;
  const bool follows = last_ != Stamp::never() && dt >= 0.0 && dt <= kLongestGap;
  last_ = sample.stamp;
  if (!follows && learn) rest_ = sample.x;
  felt_ = sample.x - rest_;
  if (!follows) return std::nullopt;
  if (learn) rest_ += std::min(1.0, dt / settling_) * felt_;
  return dt;
}

}  // namespace rubble::explore
