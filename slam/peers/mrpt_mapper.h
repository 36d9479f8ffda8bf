#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "robot/model.h"
#include "slam/mapper.h"
#include "slam/mrpt/mrpt_slam.h"
#include "slam/scan/level_scan.h"
#include "slam/scan/odometry_track.h"
#include "slam/scan/waiting_scans.h"

namespace rubble::slam {

/// One of MRPT's map builders as a mapper: scans and odometry become pairs of action and observation, one a scan, as
/// MRPT's own programs make them of a log; their grid becomes our map. A scan waits for the odometry that follows it.
/// MRPT's builders take a scan as one instant, so it is given to them as it would have looked at the middle of its
/// sweep: a robot that turns would else bend their maps, which says nothing about their methods.
class MrptMapper : public Mapper {
 public:
  /// `resolution`: of the builder's grid [m].
  MrptMapper(const robot::RobotModel& model, double resolution, std::unique_ptr<MapBuilder> builder);

  void update(const robot::Inputs& inputs) override;
  const CountMap& map() const override { return map_; }
  mrpt::math::TPose2D pose() const override;
  PoseCovariance covariance() const override { return covariance_; }
  std::uint64_t revision() const override { return revision_; }
  std::optional<mrpt::math::TPose2D> pose_at(Stamp stamp) const override;
  const Trajectory& trajectory() const override { return trajectory_; }
  const Trajectory& live_trajectory() const override { return live_; }
  const std::vector<mrpt::math::TPoint2D>& last_hits() const override { return last_hits_; }
  const MapperCounts& counts() const override { return counts_; }

 private:
  void take(const robot::LaserScan& scan);
  robot::LaserScan as_instant(const robot::LaserScan& scan, const ScanPoints& points) const;
  void follow_path(Stamp stamp, const mrpt::math::TPose2D& T_odom_base);
  void take_grid();

  robot::RobotModel model_;
  std::unique_ptr<MapBuilder> builder_;
  OdometryTrack odometry_;
  WaitingScans waiting_;
  std::optional<mrpt::math::TPose2D> T_odom_scan_;  ///< at the last scan

  /// Where a scan lies on the builder's path.
  struct Anchor {
    Stamp stamp;
    std::size_t step;
    mrpt::math::TPose2D T_step_base;  ///< by odometry
  };
  std::vector<Anchor> anchors_;
  std::vector<mrpt::math::TPose2D> path_;
  mrpt::math::TPose2D T_odom_step_;  ///< at the last step
  std::size_t mapped_ = 0;

  LevelScan level_scan_;
  CountMap map_;
  PoseCovariance covariance_;
  std::uint64_t revision_ = 0;
  Trajectory trajectory_;
  Trajectory live_;
  std::vector<mrpt::math::TPoint2D> last_hits_;
  MapperCounts counts_;
};

}  // namespace rubble::slam
