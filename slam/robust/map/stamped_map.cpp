#include "slam/robust/map/stamped_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/angle.h"
#include "base/planar.h"
#include "slam/robust/map/crisp_walls.h"
#include "slam/robust/map/gone_things.h"
#include "slam/robust/map/stamped_part.h"
#include "slam/robust/map/wall_phase.h"

namespace rubble::slam {

using mrpt::math::TPose2D;

namespace {

constexpr double kTolerance = 0.2;  ///< scans may lie wrong by this much of a cell at the end ...
constexpr double kTolerable = 0.5;  ///< ... by this much on the way, where others are under way to move them too ...
constexpr double kLever = 4.0;      ///< ... so far from the robot [m]
constexpr Work kWorkPerBeam = 60;   ///< of drawing a scan
constexpr Work kDrawnCellsPerWork = 4;  ///< of the window that is drawn in
constexpr Work kWorkPerLook = 20;
constexpr double kLevelGround = deg_to_rad(2.0);
constexpr double kAcross = 0.99;     ///< of a normal's part along an axis, of walls across it: within 8 deg
constexpr double kLeastShift = 0.1;  ///< cells

/// A laser that leans, or stands higher than usual, looks over what is low.
bool is_level(const ScanTilt& tilt) {
  return std::max({std::abs(tilt.pitch), std::abs(tilt.roll), std::abs(tilt.body_pitch), std::abs(tilt.body_roll)}) <
         kLevelGround;
}

}  // namespace

StampedMap::StampedMap(CountMap map, const mrpt::math::TPose3D& T_base_laser, const LevelScanConfig& config)
    : map_(std::move(map)), level_scan_(T_base_laser, config), tolerance_(kTolerable) {}

void StampedMap::thin() { thin_walls(map_); }

void StampedMap::drop_gone() {
  GoneThings things(map_);
  if (!things.any()) return;
  for (const Entry& entry : scans_)
    things.look(entry.T_map_base, raw_points(entry.scan), !entry.scan.tilt || is_level(*entry.scan.tilt));
  map_.clear_hits(things.cells());
}

void StampedMap::lay_raster(const KeyFrames& frames) {
  WallPhase across_x, across_y;
  for (int i = 0; i < frames.size(); ++i) {
    const PlanarTransform to_map(frames.pose(i));
    const double c = std::cos(frames.pose(i).phi);
    const double s = std::sin(frames.pose(i).phi);
    for (const OrientedPoint& point : frames[i].cloud.points) {
      if (!point.has_normal()) continue;
      const double nx = c * static_cast<double>(point.nx) - s * static_cast<double>(point.ny);
      const double ny = s * static_cast<double>(point.nx) + c * static_cast<double>(point.ny);
      const mrpt::math::TPoint2D p = to_map({static_cast<double>(point.x), static_cast<double>(point.y)});
      const double x = p.x / map_.frame().resolution;
      const double y = p.y / map_.frame().resolution;
      if (std::abs(nx) > kAcross) across_x.add(x, y, nx > 0.0);
      if (std::abs(ny) > kAcross) across_y.add(y, x, ny > 0.0);
    }
  }
  const double cell = map_.frame().resolution;
  const double dx = cell * across_x.shift(map_.frame().x0 / cell);
  const double dy = cell * across_y.shift(map_.frame().y0 / cell);
  if (std::max(std::abs(dx), std::abs(dy)) < kLeastShift * cell) return;
  map_.begin_anew(dx, dy);
  for (Entry& entry : scans_) {
    entry.T_map_base = frames.pose(entry.frame) + entry.T_frame_base;
    map_.stamp(entry.T_map_base, points_of(entry.scan));
  }
}

/// Lone hits among them.
ScanPoints StampedMap::raw_points(const PackedScan& scan) {
  return level_scan_.points(unpacked(scan), scan.motion ? &*scan.motion : nullptr, scan.tilt ? &*scan.tilt : nullptr);
}

ScanPoints StampedMap::points_of(const PackedScan& scan) {
  ScanPoints points = raw_points(scan);
  drop_lone_hits(points);
  cut_to({}, map_.frame().resolution, points);
  return points;
}

void StampedMap::add(const KeyFrames& frames, int frame, const TPose2D& T_frame_base, PackedScan scan, Work* work) {
  Entry entry{frame, T_frame_base, frames.pose(frame) + T_frame_base, std::move(scan)};
  map_.stamp(entry.T_map_base, points_of(entry.scan));
  if (work != nullptr) *work += effort(entry);
  scans_.push_back(std::move(entry));
}

/// Of what the map drew last.
Work StampedMap::effort(const Entry& entry) const {
  return kWorkPerBeam * static_cast<Work>(entry.scan.ranges.size()) +
         static_cast<Work>(map_.drawn_cells()) / kDrawnCellsPerWork;
}

bool StampedMap::lies_wrong(const Entry& entry, const TPose2D& T_map_base) const {
  const double shift = length(T_map_base.x - entry.T_map_base.x, T_map_base.y - entry.T_map_base.y);
  const double turn = std::abs(wrap_angle(T_map_base.phi - entry.T_map_base.phi));
  return shift + kLever * turn > tolerance_ * map_.frame().resolution;
}

void StampedMap::set_right(const KeyFrames& frames) {
  tolerance_ = kTolerance;
  moved();
  Work budget = std::numeric_limits<Work>::max();
  work(frames, budget);
  tolerance_ = kTolerable;
}

void StampedMap::work(const KeyFrames& frames, Work& budget) {
  while (to_check_ > 0 && budget > 0) {
    Entry& entry = scans_[--to_check_];
    budget -= kWorkPerLook;
    const TPose2D T_map_base = frames.pose(entry.frame) + entry.T_frame_base;
    if (!lies_wrong(entry, T_map_base)) continue;
    const ScanPoints points = points_of(entry.scan);
    map_.restamp(entry.T_map_base, T_map_base, points);
    entry.T_map_base = T_map_base;
    budget -= effort(entry);
  }
}

}  // namespace rubble::slam
