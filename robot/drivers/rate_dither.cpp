#include "robot/drivers/rate_dither.h"

#include <algorithm>
#include <cmath>

namespace rubble::robot {

int RateDither::next(double wanted, Stamp now) {
  if (last_ != Stamp::never()) owed_ += (wanted_ - sent_) * std::max(0.0, now - last_);
  // After a pause or a long wait nobody wants the past back at once.
  owed_ = std::clamp(owed_, -kPeriod, kPeriod);
  last_ = now;
  wanted_ = wanted;
  if (wanted == 0.0) owed_ = 0.0;
  sent_ = static_cast<int>(std::lround(wanted + owed_ / kPeriod));
  return sent_;
}

bool RateDither::restless() const { return wanted_ != sent_; }

}  // namespace rubble::robot
