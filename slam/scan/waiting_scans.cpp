#include "slam/scan/waiting_scans.h"

#include <algorithm>
#include <utility>

namespace rubble::slam {

using robot::LaserScan;

bool WaitingScans::add(const LaserScan& scan) {
  if (scan.ranges.empty() || scan.middle() <= newest_) return false;
  newest_ = scan.middle();
  waiting_.push_back(scan);
  return true;
}

bool WaitingScans::ready(const OdometryTrack& odometry, Stamp now) const {
  if (waiting_.empty()) return false;
  const Stamp reference = front().middle();
  return odometry.newest() >= reference || now - reference > OdometryTrack::kMaxExtrapolation;
}

LaserScan WaitingScans::take() {
  LaserScan scan = std::move(waiting_.front());
  waiting_.pop_front();
  return scan;
}

Stamp WaitingScans::oldest_needed(const OdometryTrack& odometry) const {
  const Stamp oldest = odometry.newest() - kLateScan;
  if (waiting_.empty()) return oldest;
  return std::min({oldest, front().stamp, front().beam_stamp(front().ranges.size() - 1)});
}

std::optional<SweepMotion> sweep_motion(const OdometryTrack& odometry, const LaserScan& scan) {
  return sweep_motion(odometry, scan, scan.middle());
}

std::optional<SweepMotion> sweep_motion(const OdometryTrack& odometry, const LaserScan& scan, Stamp reference) {
  if (scan.beam_period == 0.0 || odometry.empty()) return std::nullopt;
  return SweepMotion{odometry.between(reference, scan.stamp),
                     odometry.between(reference, scan.beam_stamp(scan.ranges.size() - 1))};
}

}  // namespace rubble::slam
