#pragma once

#include <atomic>
#include <cstdint>

#include "base/stamp.h"

namespace rubble::robot {

/// Whether this computer stood still, asleep or busy with something else: what waited meanwhile tells of a world that
/// is past. One thread looks, any may ask.
class Standstill {
 public:
  static constexpr double kBusy = 1.0;  ///< so long without a look is no busy moment [s]

  /// `asleep`: how long the computer was suspended, since it was switched on [s].
  Standstill(Stamp now, double asleep) : looked_ns_(now.ns), asleep_(asleep) {}

  /// To be called about fifty times a second. True: it stood still just before.
  bool look(Stamp now, double asleep);
  /// It has not stood still lately, whoever wakes first after it.
  bool is_over(Stamp now, double asleep) const;
  /// How long it stood still last [s].
  double seconds() const { return seconds_; }
  /// The same at `now`, also where look() is still to come.
  double seconds(Stamp now, double asleep) const;

 private:
  std::atomic<std::int64_t> looked_ns_;
  std::atomic<double> asleep_;                             ///< when it looked [s]
  std::atomic<std::int64_t> until_ns_{Stamp::never().ns};  ///< nothing is driven up to here
  std::atomic<double> seconds_{0.0};
};

}  // namespace rubble::robot
