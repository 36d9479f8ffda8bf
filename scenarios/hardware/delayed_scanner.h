#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "robot/drivers/scanner.h"

namespace rubble::scenarios {

/// A scanner whose scans are older than their stamps say, by a delay that was measured (`rubble calibrate`).
class DelayedScanner : public robot::Scanner {
 public:
  DelayedScanner(std::unique_ptr<robot::Scanner> inner, double delay) : inner_(std::move(inner)), delay_(delay) {}

  std::vector<robot::LaserScan> take() override {
    std::vector<robot::LaserScan> scans = inner_->take();
    for (robot::LaserScan& scan : scans) scan.stamp = scan.stamp - delay_;
    return scans;
  }
  robot::ScannerStatus status() const override { return inner_->status(); }
  robot::ScannerInfo info() const override { return inner_->info(); }
  int descriptor() const override { return inner_->descriptor(); }

 private:
  std::unique_ptr<robot::Scanner> inner_;
  double delay_;
};

}  // namespace rubble::scenarios
