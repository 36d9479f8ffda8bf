#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <vector>

#include "robot/measurements.h"
#include "slam/robust/tracking/local_tracker.h"

namespace rubble::slam {

/// Tells a scanner that hangs: it gives out one scan again and again, with new stamps, while the wheels roll on, and
/// matching such scans holds the robot back. A scanner without noise, as a simulator may have, says the same all along
/// a bare corridor, where matching lets the robot go on; and of a robot that stands, though its wheels spin: it is
/// known by having repeated itself while they held, and having gone on when they rolled.
class RepeatedScans {
 public:
  /// Whether `scan` is one that was seen from elsewhere. motion: from the scan before; found: the step to that one, as
  /// matched.
  bool is_repeated(const robot::LaserScan& scan, const ExpectedMotion& motion, const mrpt::math::TPose2D& found);
  std::uint64_t count() const { return count_; }

 private:
  std::vector<float> ranges_;  ///< of the last scan
  // How the robot moved since they were seen first, by its wheels and as matched, up to the last scan.
  mrpt::math::TPose2D rolled_;
  mrpt::math::TPose2D found_;
  mrpt::math::TPose2D last_roll_;  ///< by its wheels, to the last scan
  bool moved_ = false;             ///< so far that they cannot be true
  int repeats_ = 0;
  int stood_ = 0;       ///< repeats while the wheels held
  bool exact_ = false;  ///< the scanner has no noise: what it repeats is true
  std::uint64_t count_ = 0;
};

}  // namespace rubble::slam
