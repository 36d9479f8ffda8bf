#pragma once

#include <optional>

#include "robot/drivers/clock_map.h"
#include "robot/drivers/scip/scip_reply.h"
#include "robot/drivers/scip/scip_scan.h"
#include "robot/measurements.h"

namespace rubble::robot::scip {

struct MadeScan {
  LaserScan scan;
  double missed = 0.0;   ///< turns between the last one and this
  double latency = 0.0;  ///< from the end of the sweep to the arrival of its last byte [s]
};

/// Gives the turns of one connection their time on the computer's clock.
class ScanMaker {
 public:
  /// `has_clock`: SCIP 2.0; else the arrival counts.
  ScanMaker(const Geometry& geometry, bool has_clock, const RangeRules& rules);

  /// For answers to TM1, which narrow the constant part down.
  WrappingClock& clock() { return clock_; }
  ClockMap& map() { return map_; }

  /// Nothing for a turn that was had before. `begun` and `ended`: arrival of its first and last byte.
  std::optional<MadeScan> make(const Sweep& sweep, Stamp begun, Stamp ended);

 private:
  Geometry geometry_;
  bool has_clock_;
  RangeRules rules_;
  WrappingClock clock_;
  ClockMap map_;
  double last_turn_ = -1.0;
};

}  // namespace rubble::robot::scip
