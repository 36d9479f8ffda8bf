#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "robot/drivers/scanner.h"

namespace rubble::robot {

/// A scanner that one of MRPT's drivers (mrpt-hwdrivers, the classes below C2DRangeFinderAbstract) reads.
struct MrptScannerConfig {
  std::string type = "CHokuyoURG";  ///< MRPT's class
  std::string port;                 ///< as open_port takes it; may be empty where `parameters` say it
  /// Further `key = value` lines of the class's configuration section, see MRPT's reference; they win over ours.
  std::vector<std::pair<std::string, std::string>> parameters;
  double range_max = 4.0;        ///< beyond, a range counts as a miss [m]
  bool no_echo_is_miss = false;  ///< a range that MRPT calls invalid counts as "nothing in range"
  double scan_period = 0.1;      ///< of a turn; CHokuyoURG tells its own [s]
  double delivery = -1.0;  ///< from the last beam to the delivery by MRPT, at the least; < 0: as measured, by port [s]
  double silence = 1.0;    ///< the driver is made anew after so long without a scan [s]
  double retry = 0.5;      ///< pause between two attempts to connect [s]
};

/// A scanner read through MRPT. MRPT's drivers pull GUI and vision libraries, so they lie in a module that the first
/// call loads (about 0.4 s). Bearings and stamps of CHokuyoURG are put right: MRPT 2.5.8 spreads N beams over N steps
/// instead of N - 1 and takes the middle for the front, and stamps a turn with its arrival; other classes keep MRPT's
/// own angles. Codes are not known. Throws InputError when MRPT has no scanner of that type, RunError when the module
/// is missing.
std::unique_ptr<Scanner> mrpt_scanner(const MrptScannerConfig& config);

}  // namespace rubble::robot
