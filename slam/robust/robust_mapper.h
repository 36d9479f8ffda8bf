#pragma once

#include <memory>
#include <vector>

#include "base/angle.h"
#include "base/yaml/binder.h"
#include "robot/model.h"
#include "slam/mapper.h"
#include "slam/robust/graph/loop_closer.h"
#include "slam/robust/map/saved_map.h"
#include "slam/robust/map/stamped_map.h"
#include "slam/robust/matching/cloud.h"
#include "slam/robust/tracking/local_tracker.h"
#include "slam/scan/level_scan.h"
#include "slam/scan/sure_misses.h"
#include "slam/scan/tilt_track.h"

namespace rubble::slam {

/// Parameters of the robust mapper; docs/robust_mapper.md says what they were chosen by.
struct RobustConfig {
  RobustConfig() {
    scan.floor_margin = 0.08;
    scan.ramp_margin = 0.22;  // a ramp of 10 deg on a pallet ends 0.21 m above its foot
    loop.blur = 0.0;          // by the reach of the scanner, see suited_to()
  }

  int map_cells = 800;                 ///< cells a side at the start; the map grows when needed
  double resolution = 0.05;            ///< cell edge [m]
  int max_map_cells = 8000;            ///< the map grows up to so many cells a side
  bool deskew = true;                  ///< each beam at its own time; false: a scan is taken as one instant
  bool use_tilt = true;                ///< project scans by what the accelerometer says
  double map_distance = 0.15;          ///< a scan enters the map after this much motion [m]
  double map_turn = deg_to_rad(10.0);  ///< or this much turn [rad]
  int first_scans = 5;                 ///< so many scans are mapped at the start although the robot stands
  double frame_distance = 0.30;        ///< a key frame is taken after this much motion [m]
  double frame_turn = 0.20;            ///< or this much turn [rad]
  double frame_overlap = 0.60;         ///< or when fewer points lie on the local map
  int exact_frames = 4000;             ///< from so many key frames on, known ground adds none
  bool drop_gone = true;               ///< small things that were later seen through leave the final map
  bool thin_walls = true;              ///< walls that fill two cells of the final map lose the one hit less often
  bool loops = true;                   ///< close loops
  bool wall_compass = true;            ///< keep the heading by walls that run one way or across it
  double budget_ms = 8.0;  ///< work put off to later scans beyond this; in work, not time: a unit is about 1 ns
  MissTrust misses = MissTrust::Sure;  ///< beams without an echo that free cells of the map; matching knows none
  LevelScanConfig scan;
  CloudConfig cloud;
  TiltConfig tilt;
  TrackerConfig tracker;
  LoopConfig loop;
};

void bind(Binder& binder, RobustConfig& config);

/// The parameters left at 0, by how far the scanner sees: what is seen from afar is seen thinly, and stays in sight
/// longer.
RobustConfig suited_to(const robot::LaserModel& laser, RobustConfig config);

/// How scans enter the map: as they are matched, and with misses.
LevelScanConfig stamping(const RobustConfig& config);

/// Online SLAM by matching with a local map, key frames and a graph of their poses with verified loops
/// (docs/robust_mapper.md). Poses of the past move when loops close: revision() then rises.
class RobustMapper : public Mapper {
 public:
  RobustMapper(const robot::RobotModel& model, const RobustConfig& config, std::uint64_t seed);
  ~RobustMapper() override;

  void update(const robot::Inputs& inputs) override;
  void finish() override;
  const CountMap& map() const override;
  mrpt::math::TPose2D pose() const override;
  PoseCovariance covariance() const override;
  std::uint64_t revision() const override;
  bool settled() const override;
  std::optional<mrpt::math::TPose2D> pose_at(Stamp stamp) const override;
  const Trajectory& trajectory() const override;
  const Trajectory& live_trajectory() const override;
  const std::vector<mrpt::math::TPoint2D>& last_hits() const override;
  double blind_way() const override;
  const MapperCounts& counts() const override;
  std::vector<MapperFigure> figures() const override;
  const ScanRecords* scan_records() const override;
  std::string loop_table(const StampName& name) const override;
  std::vector<FoundLoop> found_loops() const override;
  std::string saved_map() const override;

  const KeyFrames& key_frames() const;
  SavedMap saved() const;
  /// Goes on in another map, in which the drive so far lies at T_map_drive. Where the map grows, `frames` end with the
  /// drive's own; else the drive's key frames are dropped and no more are made.
  void go_on_in(KeyFrames frames, StampedMap map, const mrpt::math::TPose2D& T_map_drive, bool grows);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble::slam
