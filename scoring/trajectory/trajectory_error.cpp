#include "scoring/trajectory/trajectory_error.h"

#include <cmath>
#include <vector>

#include "base/rigid.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

double position_rmse(const std::vector<PosePair>& pairs, const TPose2D& T_truth_estimate) {
  double sum = 0.0;
  for (const PosePair& pair : pairs) {
    const TPoint2D p = T_truth_estimate.composePoint(TPoint2D(pair.estimate.x, pair.estimate.y));
    const double dx = p.x - pair.truth.x;
    const double dy = p.y - pair.truth.y;
    sum += dx * dx + dy * dy;
  }
  return std::sqrt(sum / static_cast<double>(pairs.size()));
}

/// Umeyama 1991 in the plane, scale 1: the rotation that turns the centred estimate onto the centred truth.
TPose2D best_rigid(const std::vector<PosePair>& pairs) {
  std::vector<TPoint2D> estimate;
  std::vector<TPoint2D> truth;
  for (const PosePair& pair : pairs) {
    estimate.push_back({pair.estimate.x, pair.estimate.y});
    truth.push_back({pair.truth.x, pair.truth.y});
  }
  return fit_rigid(estimate, truth);
}

}  // namespace

TrajectoryError trajectory_error(const Trajectory& estimate, const Trajectory& truth) {
  const std::vector<PosePair> pairs = associate(estimate, truth);
  TrajectoryError out;
  out.matched = pairs.size();
  if (pairs.empty()) return out;
  const TPose2D T_truth_estimate = pairs.front().truth + (TPose2D(0.0, 0.0, 0.0) - pairs.front().estimate);
  out.ate_first_m = position_rmse(pairs, T_truth_estimate);
  out.ate_aligned_m = position_rmse(pairs, best_rigid(pairs));
  return out;
}

}  // namespace rubble::scoring
