#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/slam/CMetricMapBuilderICP.h>

#include "slam/mrpt/module/action_observation.h"
#include "slam/mrpt/module/builders.h"
#include "slam/mrpt/module/mrpt_grid.h"

namespace rubble::slam {
namespace {

class IcpBuilder : public MapBuilder {
 public:
  IcpBuilder(const robot::RobotModel& model, const MrptIcpConfig& config) : T_base_laser_(model.T_base_laser) {
    builder_.setVerbosityLevel(mrpt::system::LVL_ERROR);
    auto& icp = builder_.ICP_params;
    icp.maxIterations = 80;
    icp.thresholdDist = 0.3;
    icp.thresholdAng = deg_to_rad(5.0);
    icp.ALFA = 0.8;
    icp.smallestThresholdDist = 0.05;
    icp.onlyUniqueRobust = true;
    icp.corresponding_points_decimation = 5;
    auto& options = builder_.ICP_options;
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
    builder_.initialize();
  }

  void process(const mrpt::math::TPose2D& step, const robot::LaserScan& scan) override {
    ActionObservation pair(step, scan, T_base_laser_);
    builder_.processActionObservation(pair.action, pair.frame);
    const auto mean = builder_.getCurrentPoseEstimation()->getMeanVal();
    path_of_scans_.emplace_back(mean.x(), mean.y(), mean.yaw());
  }

  std::vector<mrpt::math::TPose2D> path() const override { return path_of_scans_; }

  PoseCovariance uncertainty() const override {
    mrpt::poses::CPosePDFGaussian pose;
    pose.copyFrom(*builder_.getCurrentPoseEstimation());
    return PoseCovariance(pose.cov);
  }

  BuilderGrid grid() const override {
    return grid_of(*builder_.getCurrentlyBuiltMetricMap()->mapByClass<mrpt::maps::COccupancyGridMap2D>());
  }

  std::size_t inserted() const override { return builder_.getCurrentlyBuiltMapSize(); }

 private:
  mutable mrpt::slam::CMetricMapBuilderICP builder_;  ///< asking is not const in MRPT
  mrpt::math::TPose3D T_base_laser_;
  std::vector<mrpt::math::TPose2D> path_of_scans_;
};

}  // namespace

std::unique_ptr<MapBuilder> make_icp_builder(const robot::RobotModel& model, const MrptIcpConfig& config) {
  return std::make_unique<IcpBuilder>(model, config);
}

}  // namespace rubble::slam
