#pragma once

#include <functional>
#include <memory>
#include <string>

#include "robot/drivers/port.h"
#include "robot/drivers/scanner.h"

namespace rubble::robot {

struct ScipScannerConfig {
  std::string port;  ///< as open_port takes it
  /// Opens the port; another one may record what passes.
  std::function<std::unique_ptr<Port>(const std::string&)> open = open_port;
  double range_max = 4.0;       ///< beyond, a range counts as a miss [m]; the URG-04LX is specified up to here
  bool no_echo_is_miss = true;  ///< code 0, no echo, counts as "nothing in range", else as no measurement
  bool only_scip1 = false;      ///< do not switch the device to SCIP 2.0
  double silence = 0.5;         ///< the device is started anew after so long without a scan [s]
  double retry = 0.5;           ///< pause between two attempts to connect [s]
};

/// Our own driver of Hokuyo's scanners by SCIP 2.0, or 1.1. Every sum and length is checked; ranges below 20 mm are
/// codes and are kept as such. Stamps are the device's, mapped to the computer's clock; SCIP 1.1 has none, there the
/// arrival counts as the end of the turn.
class ScipScanner : public Scanner {
 public:
  /// Throws InputError on a bad port word; a device that is not there is not an error (see status()).
  explicit ScipScanner(const ScipScannerConfig& config);
  ~ScipScanner() override;

  std::vector<LaserScan> take() override;
  ScannerStatus status() const override;
  ScannerInfo info() const override;
  int descriptor() const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble::robot
