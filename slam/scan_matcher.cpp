#include "slam/scan_matcher.h"

#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/slam/CICP.h>

#include <algorithm>
#include <cmath>

namespace rubble::slam {

using mrpt::maps::CSimplePointsMap;
using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

void insert(CSimplePointsMap& map, const TPoint2D& p) {
  map.insertPointFast(static_cast<float>(p.x), static_cast<float>(p.y), 0.0f);
}

/// The surfaces of a scan as a dense chain of points. Point-to-point ICP on the raw beams drags the robot back along a
/// corridor: the far, sparse points of both scans sit at the same bearings and pair with each other.
void surface_points(const ScanPoints& scan, const ScanMatcherConfig& config, CSimplePointsMap& map) {
  map.clear();
  TPoint2D kept;
  bool any = false;
  for (std::size_t i = 0; i < scan.rays.size(); ++i) {
    if (!scan.rays[i].hit) continue;
    const TPoint2D& p = scan.rays[i].end;
    if (!any || std::hypot(p.x - kept.x, p.y - kept.y) >= config.surface_spacing) {
      insert(map, p);
      kept = p;
      any = true;
    }
    if (!scan.rays[i].joined || !scan.rays[i + 1].hit) continue;
    const TPoint2D& q = scan.rays[i + 1].end;
    const double gap = std::hypot(q.x - p.x, q.y - p.y);
    if (gap > config.max_gap) continue;
    const int pieces = static_cast<int>(gap / config.surface_spacing);
    for (int piece = 1; piece < pieces; ++piece) {
      const double u = static_cast<double>(piece) / pieces;
      kept = {p.x + u * (q.x - p.x), p.y + u * (q.y - p.y)};
      insert(map, kept);
    }
  }
  map.mark_as_modified();
}

/// Measured points of a scan, thinned so that near walls do not outvote far ones.
void thinned_points(const ScanPoints& scan, double spacing, CSimplePointsMap& map) {
  map.clear();
  TPoint2D kept;
  bool any = false;
  for (const TPoint2D& p : scan.hits) {
    if (any && std::hypot(p.x - kept.x, p.y - kept.y) < spacing) continue;
    insert(map, p);
    kept = p;
    any = true;
  }
  map.mark_as_modified();
}

}  // namespace

struct ScanMatcher::Impl {
  ScanMatcherConfig config;
  mrpt::slam::CICP icp;
  CSimplePointsMap last;
  CSimplePointsMap now;
};

ScanMatcher::ScanMatcher(const ScanMatcherConfig& config) : impl_(std::make_unique<Impl>()) {
  impl_->config = config;
  auto& options = impl_->icp.options;
  options.ICP_algorithm = mrpt::slam::icpClassic;
  options.thresholdDist = config.first_distance;
  options.thresholdAng = 0.0;
  options.ALFA = 0.5;
  options.smallestThresholdDist = config.last_distance;
  options.maxIterations = 40;
  options.minAbsStep_trans = 2e-4;
  options.minAbsStep_rot = 2e-4;
  options.corresponding_points_decimation = 1;  // the points are thinned already
  options.doRANSAC = false;                     // it draws random numbers
  options.skip_cov_calculation = true;
  options.skip_quality_calculation = true;
}

ScanMatcher::~ScanMatcher() = default;

void ScanMatcher::set_last(const ScanPoints& scan) { surface_points(scan, impl_->config, impl_->last); }

ScanMatch ScanMatcher::match(const ScanPoints& scan, const TPose2D& T_last_now_prior) {
  ScanMatch match{T_last_now_prior, false, 0.0};
  const ScanMatcherConfig& config = impl_->config;
  thinned_points(scan, config.point_spacing, impl_->now);
  if (impl_->last.empty() || impl_->now.empty()) return match;

  mrpt::slam::CICP::TReturnInfo info;
  const mrpt::poses::CPosePDFGaussian prior{mrpt::poses::CPose2D(T_last_now_prior)};
  const auto pdf = impl_->icp.AlignPDF(&impl_->last, &impl_->now, prior, info);
  const TPose2D refined = pdf->getMeanVal().asTPose();
  match.goodness = info.goodness;
  const TPose2D correction = refined - T_last_now_prior;
  match.accepted = info.goodness >= config.min_goodness &&
                   std::hypot(correction.x, correction.y) <= config.max_correction &&
                   std::abs(wrap_angle(correction.phi)) <= config.max_turn;
  if (match.accepted) match.T_last_now = refined;
  return match;
}

}  // namespace rubble::slam
