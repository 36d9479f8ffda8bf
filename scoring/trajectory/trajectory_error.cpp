#include "scoring/trajectory/trajectory_error.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/rigid.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kLeastSpread = 1e-6;  ///< of a trajectory that tells a scale, RMS [m]

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

/// Umeyama 1991, eq. (42) in the plane: what the estimate's size has to be multiplied with. `best`: the best rigid
/// alignment, which lays the means on each other.
double best_shrink(const std::vector<PosePair>& pairs, const TPose2D& best) {
  TPoint2D mean;
  for (const PosePair& pair : pairs) mean += TPoint2D(pair.truth.x, pair.truth.y);
  mean *= 1.0 / static_cast<double>(pairs.size());
  double both = 0.0, own = 0.0, true_own = 0.0;
  for (const PosePair& pair : pairs) {
    const TPoint2D e = best.composePoint(TPoint2D(pair.estimate.x, pair.estimate.y)) - mean;
    const TPoint2D t = TPoint2D(pair.truth.x, pair.truth.y) - mean;
    both += e.x * t.x + e.y * t.y;
    own += e.x * e.x + e.y * e.y;
    true_own += t.x * t.x + t.y * t.y;
  }
  const bool tells = std::min(own, true_own) > static_cast<double>(pairs.size()) * kLeastSpread * kLeastSpread;
  return tells && both > 0.0 ? both / own : 1.0;
}

}  // namespace

TrajectoryError trajectory_error(const Trajectory& estimate, const Trajectory& truth) {
  const std::vector<PosePair> pairs = associate(estimate, truth);
  TrajectoryError out;
  out.matched = pairs.size();
  if (pairs.empty()) return out;
  const TPose2D T_truth_estimate = pairs.front().truth + (TPose2D(0.0, 0.0, 0.0) - pairs.front().estimate);
  out.ate_first_m = position_rmse(pairs, T_truth_estimate);
  const TPose2D best = best_rigid(pairs);
  out.ate_aligned_m = position_rmse(pairs, best);
  const double shrink = best_shrink(pairs, best);
  out.scale = 1.0 / shrink;
  std::vector<PosePair> shrunk = pairs;
  for (PosePair& pair : shrunk) pair.estimate = {shrink * pair.estimate.x, shrink * pair.estimate.y, pair.estimate.phi};
  out.ate_scaled_m = position_rmse(shrunk, best_rigid(shrunk));
  return out;
}

}  // namespace rubble::scoring
