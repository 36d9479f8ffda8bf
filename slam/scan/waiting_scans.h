#pragma once

#include <deque>
#include <optional>

#include "robot/measurements.h"
#include "slam/scan/level_scan.h"
#include "slam/scan/odometry_track.h"

namespace rubble::slam {

constexpr double kAhead = 1.0;  ///< stamps so far in the future are wrong [s]

/// Scans that wait for odometry from after their reference time: their poses are "interpolated by the odometry data
/// reported right before and right after" (section III.B). Where none comes they are given out all the same.
class WaitingScans {
 public:
  /// False for a scan that is left out: it has no beams, or is not younger than the one before.
  bool add(const robot::LaserScan& scan);

  /// Whether the oldest scan need wait no longer.
  bool ready(const OdometryTrack& odometry, Stamp now) const;
  /// The oldest scan; only while there is one.
  const robot::LaserScan& front() const { return waiting_.front(); }
  robot::LaserScan take();

  /// Oldest stamp that a scan, waiting or yet to come, may ask `odometry` for: a scan may be old when it comes, since
  /// it began a sweep and a transmission ago.
  Stamp oldest_needed(const OdometryTrack& odometry) const;

  static constexpr double kLateScan = 2.0;  ///< a scan may begin so long before the newest odometry [s]

 private:
  std::deque<robot::LaserScan> waiting_;
  Stamp newest_ = Stamp::never();
};

/// How the base moved during a sweep, by odometry, seen from where it was at `reference` (else in the middle of the
/// sweep). Nothing for a scan taken at one instant or without odometry.
std::optional<SweepMotion> sweep_motion(const OdometryTrack& odometry, const robot::LaserScan& scan, Stamp reference);
std::optional<SweepMotion> sweep_motion(const OdometryTrack& odometry, const robot::LaserScan& scan);

}  // namespace rubble::slam
