#pragma once

#include <cstdint>
#include <limits>

#include "base/stamp.h"

namespace rubble::explore {

/// When to plan anew: at once where something asks for it, else after a while, if the map has changed since.
class PlanClock {
 public:
  void force() { forced_ = true; }
  bool due(std::uint64_t map_version, Stamp now) const { return forced_ || (now >= next_ && map_version != planned_); }
  /// A plan is made now; none is due for `wait` [s]. Says whether it is the first one on this map.
  bool plan(std::uint64_t map_version, double wait, Stamp now) {
    const bool new_map = map_version != planned_;
    forced_ = false;
    planned_ = map_version;
    last_ = now;
    next_ = now + wait;
    return new_map;
  }
  /// Since the last plan [s]; infinite before the first.
  double age(Stamp now) const {
    return last_ == Stamp::never() ? std::numeric_limits<double>::infinity() : now - last_;
  }

 private:
  bool forced_ = true;
  std::uint64_t planned_ = 0;  ///< version of the map
  Stamp next_ = Stamp::never();
  Stamp last_ = Stamp::never();
};

}  // namespace rubble::explore
