#pragma once

#include <cstddef>

#include "base/stamp.h"

namespace rubble::robot {

/// Gives stamps to reports that carry no time of their own but leave the device in a steady cycle: the earliest
/// arrivals are believed, later ones were held up on their way. Drift of up to kSlew per cycle is followed.
class CycleClock {
 public:
  static constexpr double kSlew = 0.05e-3;  ///< [s]

  /// The cycle the device says it has [s]; 0: unknown, arrivals count as they are.
  void set_cycle(double cycle) { cycle_ = cycle; }
  /// When the report that arrived at `received` left, `behind` later ones with it in the same piece: what was held up
  /// together left a cycle apart. Always later than the one before.
  Stamp stamp(Stamp received, std::size_t behind = 0);
  /// A new connection.
  void reset() { last_ = Stamp::never(); }

 private:
  double cycle_ = 0.0;
  Stamp last_ = Stamp::never();
  int late_ = 0;  ///< reports in a row that came much later than foretold
};

}  // namespace rubble::robot
