#pragma once

#include "base/stamp.h"
#include "robot/drivers/scip/scip_reply.h"
#include "robot/measurements.h"

namespace rubble::robot::scip {

/// How numbers become ranges.
struct RangeRules {
  double range_max = 4.0;       ///< beyond: a miss [m]
  bool no_echo_is_miss = true;  ///< code 0 counts as a miss, else as no measurement
};

/// The scan of a turn whose step 0 was passed at `turn`.
LaserScan scan_of(const Sweep& sweep, const Geometry& geometry, const RangeRules& rules, Stamp turn);

}  // namespace rubble::robot::scip
