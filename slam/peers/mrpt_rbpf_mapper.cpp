#include "slam/peers/mrpt_rbpf_mapper.h"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/random/RandomGenerators.h>
#include <mrpt/slam/CMetricMapBuilderRBPF.h>

#include <deque>

#include "slam/peers/mrpt_grid.h"

namespace rubble::slam {

void bind(Binder& binder, MrptRbpfConfig& c) {
  binder.number("resolution_m", c.resolution, 0.01, 1.0);
  binder.integer("particles", c.particles, 1, 10000);
  binder.number("localize_distance_m", c.localize_distance, 0.0, 10.0);
  binder.degrees("localize_turn_deg", c.localize_turn, 0.0, 180.0);
  binder.number("insert_distance_m", c.insert_distance, 0.0, 10.0);
  binder.degrees("insert_turn_deg", c.insert_turn, 0.0, 180.0);
}

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

}  // namespace

struct MrptRbpfMapper::Impl {
  Impl(const robot::RobotModel& model, const MrptRbpfConfig& config) : builder(options_of(model, config)) {}
  mutable mrpt::slam::CMetricMapBuilderRBPF builder;  ///< asking is not const in MRPT
};

MrptRbpfMapper::MrptRbpfMapper(const robot::RobotModel& model, const MrptRbpfConfig& config, std::uint64_t seed)
    : MrptMapper(model, config.resolution) {
  mrpt::random::getRandomGenerator().randomize(static_cast<std::uint32_t>(seed ^ seed >> 32));
  impl_ = std::make_unique<Impl>(model, config);
}

MrptRbpfMapper::~MrptRbpfMapper() = default;

void MrptRbpfMapper::process(mrpt::obs::CActionCollection& action, mrpt::obs::CSensoryFrame& frame) {
  impl_->builder.processActionObservation(action, frame);
}

std::vector<mrpt::math::TPose2D> MrptRbpfMapper::path() const {
  std::deque<mrpt::math::TPose3D> steps;
  impl_->builder.getCurrentMostLikelyPath(steps);
  std::vector<mrpt::math::TPose2D> path;
  for (const auto& step : steps) path.emplace_back(step.x, step.y, step.yaw);
  return path;
}

PoseCovariance MrptRbpfMapper::uncertainty() const {
  mrpt::poses::CPosePDFGaussian pose;
  pose.copyFrom(*impl_->builder.getCurrentPoseEstimation());
  return PoseCovariance(pose.cov);
}

const mrpt::maps::COccupancyGridMap2D& MrptRbpfMapper::grid() const {
  return *impl_->builder.mapPDF.getCurrentMostLikelyMetricMap()->mapByClass<mrpt::maps::COccupancyGridMap2D>();
}

std::size_t MrptRbpfMapper::inserted() const { return impl_->builder.getCurrentlyBuiltMapSize(); }

}  // namespace rubble::slam
