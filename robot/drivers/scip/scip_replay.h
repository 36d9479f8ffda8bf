#pragma once

#include <cstdint>
#include <vector>

#include "robot/drivers/black_box.h"
#include "robot/drivers/scip/scip_scan.h"
#include "robot/measurements.h"

namespace rubble::robot {

/// What our scanner driver made of a black box.
struct ReplayedScans {
  std::vector<LaserScan> scans;
  std::uint64_t damaged = 0;  ///< replies
  std::uint64_t missed = 0;   ///< turns
};

/// Reads the conversation with the device `urg` again, at the times it had.
ReplayedScans replay_scanner(const std::vector<BlackBoxEntry>& entries, const scip::RangeRules& rules);

}  // namespace rubble::robot
