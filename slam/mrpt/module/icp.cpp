#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/slam/CICP.h>

#include "slam/mrpt/module/builders.h"
#include "slam/mrpt/module/match_target.h"

namespace rubble::slam {
namespace {

void take(const std::vector<FloatPoint>& points, mrpt::maps::CSimplePointsMap& map) {
  map.clear();
  for (const FloatPoint& p : points) map.insertPointFast(p.x, p.y, 0.0f);
  map.mark_as_modified();
}

class PointToPoint : public Icp {
 public:
  explicit PointToPoint(const IcpOptions& from) {
    auto& options = icp_.options;
    options.ICP_algorithm = mrpt::slam::icpClassic;
    options.thresholdDist = from.first_distance;
    options.thresholdAng = 0.0;
    options.ALFA = 0.5;
    options.smallestThresholdDist = from.last_distance;
    options.maxIterations = static_cast<unsigned>(from.max_iterations);
    options.minAbsStep_trans = 2e-4;
    options.minAbsStep_rot = 2e-4;
    options.corresponding_points_decimation = 1;  // the points are thinned already
    options.doRANSAC = false;                     // it draws random numbers
    options.skip_cov_calculation = true;
    options.skip_quality_calculation = true;
  }

  void set_last(const std::vector<FloatPoint>& points) override {
    take(points, last_);
    last_.index();
  }

  Match align(const std::vector<FloatPoint>& now, const mrpt::math::TPose2D& T_last_now_prior) override {
    take(now, now_);
    mrpt::slam::CICP::TReturnInfo info;
    const mrpt::poses::CPosePDFGaussian prior{mrpt::poses::CPose2D(T_last_now_prior)};
    const auto pdf = icp_.AlignPDF(&last_, &now_, prior, info);
    return {pdf->getMeanVal().asTPose(), info.goodness};
  }

 private:
  mrpt::slam::CICP icp_;
  MatchTarget last_;
  mrpt::maps::CSimplePointsMap now_;
};

}  // namespace

std::unique_ptr<Icp> make_icp(const IcpOptions& options) { return std::make_unique<PointToPoint>(options); }

}  // namespace rubble::slam
