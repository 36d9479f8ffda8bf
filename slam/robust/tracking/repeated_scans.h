#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <vector>

#include "robot/measurements.h"
#include "slam/robust/tracking/local_tracker.h"

namespace rubble::slam {

/// Tells a scanner that hangs: it gives out one scan again and again, with new stamps, while the wheels roll on. Of a
/// robot that stands the same scan may come twice, and is true.
class RepeatedScans {
 public:
  /// Whether `scan` is one that was seen from elsewhere. motion: from the scan before.
  bool is_repeated(const robot::LaserScan& scan, const ExpectedMotion& motion);
  std::uint64_t count() const { return count_; }

 private:
  std::vector<float> ranges_;         ///< of the last scan
  mrpt::math::TPose2D T_first_last_;  ///< how the robot moved since they were seen first, by its wheels
  bool moved_ = false;                ///< so far that they cannot be true
  std::uint64_t count_ = 0;
};

}  // namespace rubble::slam
