#pragma once

#include "base/stamp.h"

namespace rubble::robot {

/// Turns a rate into whole numbers whose mean is that rate: what was rounded away is owed to the next (first-order
/// sigma-delta modulation). Asked every kPeriod or more often, the mean over any second is right within 0.05.
class RateDither {
 public:
  static constexpr double kPeriod = 0.05;  ///< [s]

  /// The whole number that shall hold from `now` on. A wanted rate of 0 gives 0 and forgets what is owed.
  int next(double wanted, Stamp now);
  /// Whether it must be asked again soon: the rate is not a whole number, or something is owed.
  bool restless() const;

 private:
  double wanted_ = 0.0;
  int sent_ = 0;
  double owed_ = 0.0;  ///< integral of wanted minus sent [rate x s]
  Stamp last_ = Stamp::never();
};

}  // namespace rubble::robot
