#pragma once

#include <memory>

#include "base/angle.h"
#include "base/yaml/binder.h"
#include "slam/peers/mrpt_mapper.h"

namespace rubble::slam {

/// Parameters of MRPT's rbpf-slam with its ICP-based proposal. Where not said otherwise, those of the file
/// gridmapping_RBPF_grid_ICPbased_malaga.ini that MRPT ships; the distances are made for rooms of a few metres.
struct MrptRbpfConfig {
  double resolution = 0.05;  ///< cell edge [m]; shipped 0.07
  int particles = 10;
  double localize_distance = 0.2;           ///< the filter steps after so much motion [m]; shipped 1.2
  double localize_turn = deg_to_rad(10.0);  ///< or turn [rad]; shipped 35 deg
  double insert_distance = 0.2;             ///< a scan enters the maps after so much motion [m]; shipped 1.2
  double insert_turn = deg_to_rad(10.0);    ///< or turn [rad]; shipped 35 deg
};

void bind(Binder& binder, MrptRbpfConfig& config);

/// mrpt::slam::CMetricMapBuilderRBPF: particles that each carry a grid and a path. Shown are grid and path of the most
/// likely one; when another takes its place, the past moves.
class MrptRbpfMapper : public MrptMapper {
 public:
  MrptRbpfMapper(const robot::RobotModel& model, const MrptRbpfConfig& config, std::uint64_t seed);
  ~MrptRbpfMapper() override;

 protected:
  void process(mrpt::obs::CActionCollection& action, mrpt::obs::CSensoryFrame& frame) override;
  std::vector<mrpt::math::TPose2D> path() const override;
  PoseCovariance uncertainty() const override;
  const mrpt::maps::COccupancyGridMap2D& grid() const override;
  std::size_t inserted() const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble::slam
