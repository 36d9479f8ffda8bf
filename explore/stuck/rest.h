#pragma once

#include <optional>

#include "base/stamp.h"
#include "robot/measurements.h"

namespace rubble::explore {

/// Tells what an accelerometer feels along the body beyond what it feels at rest: a slope's share of gravity, or that
/// of a laser that is being levelled.
class Rest {
 public:
  static constexpr double kLongestGap = 0.1;  ///< samples farther apart do not belong together [s]

  /// `settling`: time constant of what counts as rest [s].
  explicit Rest(double settling) : settling_(settling) {}

  /// Takes in the next sample; `learn`: it may be one at rest. Returns how long after the one before it came [s];
  /// nothing where they do not belong together.
  std::optional<double> update(const robot::Acceleration& sample, bool learn = true);
  /// By the last sample [m/s^2].
  double felt() const { return felt_; }
  Stamp last() const { return last_; }

 private:
  double settling_;
  double rest_ = 0.0;  ///< [m/s^2]
  double felt_ = 0.0;  ///< [m/s^2]
  Stamp last_ = Stamp::never();
};

}  // namespace rubble::explore
