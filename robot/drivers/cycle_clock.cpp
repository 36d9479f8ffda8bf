#include "robot/drivers/cycle_clock.h"

#include <algorithm>
#include <cmath>

namespace rubble::robot {
namespace {

constexpr double kLongSilence = 1.0;  ///< after so long a silence the cycle starts anew [s]
constexpr double kLateShare = 0.1;    ///< of the cycle: much later than foretold
constexpr int kPatience = 20;         ///< so many in a row: the device's cycle has shifted
constexpr double kClosest = 1e-3;     ///< no device reports faster [s]

}  // namespace

Stamp CycleClock::stamp(Stamp arrived, std::size_t behind) {
  const auto later = static_cast<double>(behind);
  Stamp received = arrived - later * cycle_;
  // Where not all fit since the last one at a cycle's distance, they share what there is.
  if (last_ != Stamp::never()) received = std::max(received, last_ + (arrived - last_) / (later + 1.0));
  Stamp stamp = received;
  if (last_ != Stamp::never() && cycle_ > 0.0 && received - last_ < kLongSilence) {
    // Reports may be missing in between. One is not held up by more than most of a cycle.
    const double cycles = std::max(1.0, std::floor((received - last_) / cycle_ + 0.3));
    const Stamp foretold = last_ + cycles * cycle_;
    const double late = received - foretold;
    late_ = late > kLateShare * cycle_ ? late_ + 1 : 0;
    if (late > 0.0 && late_ < kPatience) stamp = foretold + std::min(late, kSlew);
    if (late_ >= kPatience) late_ = 0;
  }
  if (last_ != Stamp::never()) stamp = std::max(stamp, last_ + kClosest);
  last_ = stamp;
  return stamp;
}

}  // namespace rubble::robot
