#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "base/stamp.h"
#include "robot/measurements.h"
#include "slam/mapper.h"
#include "slam/robust/graph/loop_closer.h"
#include "slam/robust/matching/work.h"
#include "slam/robust/tracking/local_tracker.h"

namespace rubble::slam {

// Columns of the diary's ScanRecords.
constexpr std::size_t kInliersColumn = 0;
constexpr std::size_t kContradictionColumn = 1;  ///< zero but for a robot that is followed on a map of an earlier run
constexpr std::size_t kBeamsColumn = 8;          ///< that returned ...
constexpr std::size_t kRejectedColumn = 9;       ///< ... and of them those that the matching left out

/// What the robust mapper says of each scan.
class ScanDiary {
 public:
  ScanDiary();

  /// A scan and what became of it.
  struct Entry {
    Stamp reference;
    const robot::LaserScan& scan;
    std::size_t hits = 0;              ///< beams that the matching took
    const Tracked* tracked = nullptr;  ///< nothing for the first scan
    double contradiction = 0.0;
    Work work = 0;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the pose
    int key_frames = 0;                                    ///< so far, as all counts of loops
  };
  void write(const Entry& entry, const LoopCounts& loops);
  const ScanRecords& records() const { return records_; }

 private:
  ScanRecords records_;
};

}  // namespace rubble::slam
