// A mapper of one's own: it trusts the odometry and draws each scan where dead reckoning says it was seen.
#pragma once

#include <rubble/slam/mapper.h>

#include <cmath>

class MyMapper : public rubble::slam::Mapper {
 public:
  explicit MyMapper(const rubble::robot::RobotModel& model) : model_(model), map_(400, 400, 0.05) {}

  void update(const rubble::robot::Inputs& inputs) override {
    if (!inputs.odometry.empty()) pose_ = inputs.odometry.back().pose;
    for (const auto& scan : inputs.scans) {
      ++counts_.scans;
      rubble::slam::ScanPoints points;
      points.origin = {model_.T_base_laser.x, model_.T_base_laser.y};
      points.beam_width = scan.angle_step;
      for (std::size_t beam = 0; beam < scan.ranges.size(); ++beam) {
        const double range = scan.ranges[beam], bearing = scan.bearing(beam);
        if (!(range >= scan.range_min && range <= scan.range_max)) continue;  // nothing in range, or no measurement
        points.hits.emplace_back(points.origin.x + range * std::cos(bearing),
                                 points.origin.y + range * std::sin(bearing));
      }
      map_.stamp(pose_, points);
      ++counts_.mapped;
      trajectory_.push_back({scan.middle(), pose_});
      last_hits_.clear();
      for (const auto& p_base : points.hits) last_hits_.push_back(pose_.composePoint(p_base));
    }
  }
  const rubble::slam::CountMap& map() const override { return map_; }
  mrpt::math::TPose2D pose() const override { return pose_; }
  rubble::PoseCovariance covariance() const override { return {}; }
  std::uint64_t revision() const override { return 0; }
  std::optional<mrpt::math::TPose2D> pose_at(rubble::Stamp stamp) const override {
    return rubble::pose_at(trajectory_, stamp);
  }
  const rubble::Trajectory& trajectory() const override { return trajectory_; }
  const rubble::Trajectory& live_trajectory() const override { return trajectory_; }
  const std::vector<mrpt::math::TPoint2D>& last_hits() const override { return last_hits_; }
  const rubble::slam::MapperCounts& counts() const override { return counts_; }

 private:
  rubble::robot::RobotModel model_;
  rubble::slam::CountMap map_;
  mrpt::math::TPose2D pose_;
  rubble::Trajectory trajectory_;
  std::vector<mrpt::math::TPoint2D> last_hits_;
  rubble::slam::MapperCounts counts_;
};
