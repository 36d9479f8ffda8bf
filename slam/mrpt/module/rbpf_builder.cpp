#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/random/RandomGenerators.h>
#include <mrpt/slam/CMetricMapBuilderRBPF.h>

#include <deque>

#include "slam/mrpt/module/action_observation.h"
#include "slam/mrpt/module/builders.h"
#include "slam/mrpt/module/mrpt_grid.h"

namespace rubble::slam {
namespace {

mrpt::slam::CMetricMapBuilderRBPF::TConstructionOptions options_of(const robot::RobotModel& model,
                                                                   const MrptRbpfConfig& config) {
  mrpt::slam::CMetricMapBuilderRBPF::TConstructionOptions options;
  options.verbosity_level = mrpt::system::LVL_ERROR;
  options.localizeLinDistance = static_cast<float>(config.localize_distance);
  options.localizeAngDistance = static_cast<float>(config.localize_turn);
  options.insertionLinDistance = static_cast<float>(config.insert_distance);
  options.insertionAngDistance = static_cast<float>(config.insert_turn);
  options.PF_options.PF_algorithm = mrpt::bayes::CParticleFilter::pfOptimalProposal;
  options.PF_options.sampleSize = static_cast<unsigned>(config.particles);
  options.PF_options.BETA = 0.5;
  options.mapsInitializers.push_back(mrpt_grid(model, config.resolution));
  options.predictionOptions.pfOptimalProposal_mapSelection = 0;
  auto& icp = options.predictionOptions.icp_params;
  icp.maxIterations = 60;
  icp.thresholdDist = 0.3;  // shipped 1.0: too wide between walls 1.2 m apart
  icp.thresholdAng = deg_to_rad(5.0);
  icp.ALFA = 0.5;
  icp.smallestThresholdDist = 0.05;
  return options;
}

class RbpfBuilder : public MapBuilder {
 public:
  RbpfBuilder(const robot::RobotModel& model, const MrptRbpfConfig& config)
      : builder_(options_of(model, config)), T_base_laser_(model.T_base_laser) {}

  void process(const mrpt::math::TPose2D& step, const robot::LaserScan& scan) override {
    ActionObservation pair(step, scan, T_base_laser_);
    builder_.processActionObservation(pair.action, pair.frame);
  }

  std::vector<mrpt::math::TPose2D> path() const override {
    std::deque<mrpt::math::TPose3D> steps;
    builder_.getCurrentMostLikelyPath(steps);
    std::vector<mrpt::math::TPose2D> path;
    for (const auto& step : steps) path.emplace_back(step.x, step.y, step.yaw);
    return path;
  }

  PoseCovariance uncertainty() const override {
    mrpt::poses::CPosePDFGaussian pose;
    pose.copyFrom(*builder_.getCurrentPoseEstimation());
    return PoseCovariance(pose.cov);
  }

  BuilderGrid grid() const override {
    return grid_of(*builder_.mapPDF.getCurrentMostLikelyMetricMap()->mapByClass<mrpt::maps::COccupancyGridMap2D>());
  }

  std::size_t inserted() const override { return builder_.getCurrentlyBuiltMapSize(); }

 private:
  mutable mrpt::slam::CMetricMapBuilderRBPF builder_;  ///< asking is not const in MRPT
  mrpt::math::TPose3D T_base_laser_;
};

}  // namespace

std::unique_ptr<MapBuilder> make_rbpf_builder(const robot::RobotModel& model, const MrptRbpfConfig& config,
                                              std::uint64_t seed) {
  mrpt::random::getRandomGenerator().randomize(static_cast<std::uint32_t>(seed ^ seed >> 32));
  return std::make_unique<RbpfBuilder>(model, config);
}

}  // namespace rubble::slam
