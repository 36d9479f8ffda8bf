#pragma once

#include <string>

#include "robot/drivers/scanner.h"

namespace rubble::scenarios {

/// Whether the scanner that answers is the one that the robot file says: one line for people that tells what differs
/// and what to do; empty: they fit, or it has not told yet what it is.
std::string scanner_mismatch(const robot::ScannerInfo& found, const robot::LaserModel& file);

}  // namespace rubble::scenarios
