#include "slam/robust/stamped_map.h"

#include <cmath>
#include <utility>

#include "base/angle.h"
#include "base/planar.h"

namespace rubble::slam {

using mrpt::math::TPose2D;

namespace {

constexpr double kTolerance = 0.2;  ///< scans may lie wrong by this much of a cell ...
constexpr double kLever = 4.0;      ///< ... so far from the robot [m]
constexpr Work kWorkPerBeam = 60;   ///< of drawing a scan
constexpr Work kWorkPerLook = 20;

}  // namespace

StampedMap::StampedMap(CountMap map, const mrpt::math::TPose3D& T_base_laser, const LevelScanConfig& config)
    : map_(std::move(map)), level_scan_(T_base_laser, config) {}

ScanPoints StampedMap::points_of(const PackedScan& scan) {
  return level_scan_.points(unpacked(scan), scan.motion ? &*scan.motion : nullptr, scan.tilt ? &*scan.tilt : nullptr);
}

void StampedMap::add(const KeyFrames& frames, int frame, const TPose2D& T_frame_base, PackedScan scan, Work* work) {
  Entry entry{frame, T_frame_base, frames.pose(frame) + T_frame_base, std::move(scan)};
  map_.stamp(entry.T_map_base, points_of(entry.scan));
  if (work != nullptr) *work += kWorkPerBeam * static_cast<Work>(entry.scan.ranges.size());
  scans_.push_back(std::move(entry));
}

bool StampedMap::lies_wrong(const Entry& entry, const TPose2D& T_map_base) const {
  const double shift = length(T_map_base.x - entry.T_map_base.x, T_map_base.y - entry.T_map_base.y);
  const double turn = std::abs(wrap_angle(T_map_base.phi - entry.T_map_base.phi));
  return shift + kLever * turn > kTolerance * map_.frame().resolution;
}

void StampedMap::work(const KeyFrames& frames, Work& budget) {
  while (to_check_ > 0 && budget > 0) {
    Entry& entry = scans_[--to_check_];
    budget -= kWorkPerLook;
    const TPose2D T_map_base = frames.pose(entry.frame) + entry.T_frame_base;
    if (!lies_wrong(entry, T_map_base)) continue;
    const ScanPoints points = points_of(entry.scan);
    map_.unstamp(entry.T_map_base, points);
    map_.stamp(T_map_base, points);
    entry.T_map_base = T_map_base;
    budget -= 2 * kWorkPerBeam * static_cast<Work>(entry.scan.ranges.size());
  }
}

}  // namespace rubble::slam
