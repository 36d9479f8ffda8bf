#include "slam/scan/scan_matcher.h"

#include <cmath>
#include <vector>

#include "base/planar.h"
#include "slam/mrpt/mrpt_slam.h"

namespace rubble::slam {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

FloatPoint rounded(const TPoint2D& p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }

void set_points(std::vector<FloatPoint>& to, const Surface& surface) {
  to.clear();
  for (const SurfacePoint& point : surface.points) to.push_back(rounded(point.p));
}

/// Fills the surfaces with points closer than `spacing`. Point-to-point ICP on bare beams drags the robot back along a
/// corridor: the far, sparse points of both scans sit at the same bearings and pair with each other.
void set_dense_points(std::vector<FloatPoint>& to, const Surface& surface, double spacing) {
  to.clear();
  const std::vector<SurfacePoint>& points = surface.points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const TPoint2D& p = points[i].p;
    to.push_back(rounded(p));
    if (!points[i].joined || i + 1 == points.size()) continue;
    const TPoint2D& q = points[i + 1].p;
    const int pieces = static_cast<int>(std::ceil(distance(p, q) / spacing));
    for (int piece = 1; piece < pieces; ++piece) {
      const double u = static_cast<double>(piece) / pieces;
      to.push_back(rounded({p.x + u * (q.x - p.x), p.y + u * (q.y - p.y)}));
    }
  }
}

}  // namespace

struct ScanMatcher::Impl {
  ScanMatcherConfig config;
  std::unique_ptr<Icp> icp;
  std::vector<FloatPoint> last;
  std::vector<FloatPoint> now;
};

ScanMatcher::ScanMatcher(const ScanMatcherConfig& config) : impl_(std::make_unique<Impl>()) {
  impl_->config = config;
  impl_->icp = mrpt_slam().icp({config.first_distance, config.last_distance, config.max_iterations});
}

ScanMatcher::~ScanMatcher() = default;

void ScanMatcher::set_last(const Surface& surface) {
  set_dense_points(impl_->last, surface, impl_->config.dense_spacing);
  impl_->icp->set_last(impl_->last);
}

ScanMatch ScanMatcher::match(const Surface& now, const TPose2D& T_last_now_prior) {
  ScanMatch match{T_last_now_prior, false, 0.0};
  const ScanMatcherConfig& config = impl_->config;
  if (impl_->last.empty() || now.points.size() < static_cast<std::size_t>(config.min_points)) return match;

  set_points(impl_->now, now);
  const Icp::Match found = impl_->icp->align(impl_->now, T_last_now_prior);
  const TPose2D correction = found.T_last_now - T_last_now_prior;
  match.goodness = found.goodness;
  match.accepted = found.goodness >= config.min_goodness &&
                   length(correction.x, correction.y) <= config.max_correction &&
                   std::abs(wrap_angle(correction.phi)) <= config.max_turn;
  if (match.accepted) match.T_last_now = found.T_last_now;
  return match;
}

}  // namespace rubble::slam
