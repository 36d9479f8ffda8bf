#include "slam/peers/mrpt_icp_mapper.h"

#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/slam/CMetricMapBuilderICP.h>

#include "slam/peers/mrpt_grid.h"

namespace rubble::slam {

using mrpt::math::TPose2D;

void bind(Binder& binder, MrptIcpConfig& c) {
  binder.number("resolution_m", c.resolution, 0.01, 1.0);
  binder.number("localize_distance_m", c.localize_distance, 0.0, 10.0);
  binder.degrees("localize_turn_deg", c.localize_turn, 0.0, 180.0);
  binder.number("insert_distance_m", c.insert_distance, 0.0, 10.0);
  binder.degrees("insert_turn_deg", c.insert_turn, 0.0, 180.0);
  binder.number("min_goodness", c.min_goodness, 0.0, 1.0);
}

struct MrptIcpMapper::Impl {
  mrpt::slam::CMetricMapBuilderICP builder;
};

MrptIcpMapper::MrptIcpMapper(const robot::RobotModel& model, const MrptIcpConfig& config, std::uint64_t)
    : MrptMapper(model, config.resolution), impl_(std::make_unique<Impl>()) {
  auto& builder = impl_->builder;
  builder.setVerbosityLevel(mrpt::system::LVL_ERROR);
  auto& icp = builder.ICP_params;
  icp.maxIterations = 80;
  icp.thresholdDist = 0.3;
  icp.thresholdAng = deg_to_rad(5.0);
  icp.ALFA = 0.8;
  icp.smallestThresholdDist = 0.05;
  icp.onlyUniqueRobust = true;
  icp.corresponding_points_decimation = 5;
  auto& options = builder.ICP_options;
  options.matchAgainstTheGrid = false;
  options.localizationLinDistance = config.localize_distance;
  options.localizationAngDistance = config.localize_turn;
  options.insertionLinDistance = config.insert_distance;
  options.insertionAngDistance = config.insert_turn;
  options.minICPgoodnessToAccept = config.min_goodness;
  mrpt::maps::CSimplePointsMap::TMapDefinition points;
  points.insertionOpts.minDistBetweenLaserPoints = 0.05f;
  points.insertionOpts.isPlanarMap = true;
  points.insertionOpts.fuseWithExisting = false;
  options.mapInitializers.push_back(points);
  options.mapInitializers.push_back(mrpt_grid(model, config.resolution));
  builder.initialize();
}

MrptIcpMapper::~MrptIcpMapper() = default;

void MrptIcpMapper::process(mrpt::obs::CActionCollection& action, mrpt::obs::CSensoryFrame& frame) {
  impl_->builder.processActionObservation(action, frame);
  const auto mean = impl_->builder.getCurrentPoseEstimation()->getMeanVal();
  path_of_scans_.emplace_back(mean.x(), mean.y(), mean.yaw());
}

PoseCovariance MrptIcpMapper::uncertainty() const {
  mrpt::poses::CPosePDFGaussian pose;
  pose.copyFrom(*impl_->builder.getCurrentPoseEstimation());
  return PoseCovariance(pose.cov);
}

const mrpt::maps::COccupancyGridMap2D& MrptIcpMapper::grid() const {
  return *impl_->builder.getCurrentlyBuiltMetricMap()->mapByClass<mrpt::maps::COccupancyGridMap2D>();
}

std::size_t MrptIcpMapper::inserted() const { return impl_->builder.getCurrentlyBuiltMapSize(); }

}  // namespace rubble::slam
