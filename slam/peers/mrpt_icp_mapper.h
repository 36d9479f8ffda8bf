#pragma once

#include <memory>

#include "base/angle.h"
#include "base/yaml/binder.h"
#include "slam/peers/mrpt_mapper.h"

namespace rubble::slam {

/// Parameters of MRPT's icp-slam. Where not said otherwise, those of the file icp-slam_demo_classic.ini that MRPT
/// ships; the distances are made for rooms of a few metres.
struct MrptIcpConfig {
  double resolution = 0.05;                ///< of the grid that is shown [m]
  double localize_distance = 0.1;          ///< ICP after so much motion [m]; shipped 0.2
  double localize_turn = deg_to_rad(5.0);  ///< or turn [rad]
  double insert_distance = 0.3;            ///< a scan enters the map after so much motion [m]; shipped 1.2
  double insert_turn = deg_to_rad(15.0);   ///< or turn [rad]; shipped 45 deg
  double min_goodness = 0.4;               ///< of an ICP that is believed
};

void bind(Binder& binder, MrptIcpConfig& config);

/// mrpt::slam::CMetricMapBuilderICP: each scan is matched to a map of points. Poses of the past stay.
class MrptIcpMapper : public MrptMapper {
 public:
  MrptIcpMapper(const robot::RobotModel& model, const MrptIcpConfig& config, std::uint64_t seed);
  ~MrptIcpMapper() override;

 protected:
  void process(mrpt::obs::CActionCollection& action, mrpt::obs::CSensoryFrame& frame) override;
  std::vector<mrpt::math::TPose2D> path() const override { return path_of_scans_; }
  PoseCovariance uncertainty() const override;
  const mrpt::maps::COccupancyGridMap2D& grid() const override;
  std::size_t inserted() const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::vector<mrpt::math::TPose2D> path_of_scans_;
};

}  // namespace rubble::slam
