#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <vector>

#include "robot/measurements.h"
#include "slam/robust/tracking/local_tracker.h"

namespace rubble::slam {

/// Tells a scanner that hangs: it gives out one scan again and again, with new stamps, while the wheels roll on. A
/// scanner without noise, as a simulator may have, says the same of a robot that stands, though its wheels spin: it is
/// known by having repeated itself while they held, and having gone on when they rolled.
class RepeatedScans {
 public:
  /// Whether `scan` is one that was seen from elsewhere. motion: from the scan before.
  bool is_repeated(const robot::LaserScan& scan, const ExpectedMotion& motion);
  std::uint64_t count() const { return count_; }

 private:
  std::vector<float> ranges_;         ///< of the last scan
  mrpt::math::TPose2D T_first_last_;  ///< how the robot moved since they were seen first, by its wheels
  bool moved_ = false;                ///< so far that they cannot be true
  int stood_ = 0;                     ///< repeats while the wheels held
  bool exact_ = false;                ///< the scanner has no noise: what it repeats is true
  std::uint64_t count_ = 0;
};

}  // namespace rubble::slam
