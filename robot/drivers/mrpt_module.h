#pragma once

#include <string>

#include "robot/drivers/mrpt_scanner.h"

/// The border between the program and the module with MRPT's drivers: one function, found by its name.
namespace rubble::robot {

/// Makes the scanner; `now` is the program's host_now. nullptr: `trouble` says why, in one line.
using MrptScannerFactory = Scanner* (*)(const MrptScannerConfig& config, Stamp (*now)(), std::string& trouble);

constexpr const char* kMrptScannerSymbol = "rubble_make_mrpt_scanner";

}  // namespace rubble::robot
