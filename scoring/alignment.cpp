#include "scoring/alignment.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/angle.h"
#include "scoring/trust.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr WallMatch::Stiffness kSoft = {0.0, 0.0005, 0.0005, 0.001};

/// Of the fits that belong to the best pose, the one with most walls within a metre and least contradicted: a bent map
/// has a pose for each of its parts, and this is the one for the whole.
TPose2D fit_to_the_whole(const std::vector<Hypothesis>& hypotheses, const WallMatch& match,
                         const WallMatch::Kernel& metre) {
  const Hypothesis& best = hypotheses.front();
  TPose2D pick = best.T_best;
  double most = whole_agreement(match.evidence(match.rigid(pick), metre));
  for (const Hypothesis& h : hypotheses) {
    if (!same_pose(h.T_best, best.T_best, match.map_centre(), 2.5, 0.15)) continue;
    const double agreement = whole_agreement(match.evidence(match.rigid(h.T_wide), metre));
    if (agreement <= most) continue;
    most = agreement;
    pick = h.T_wide;
  }
  // A soft bend shows where each part of the map belongs; its nearest rigid transform errs differently from the pick,
  // and their mean less than either.
  Warp bent = match.rigid(best.T_wide);
  for (const double sigma : {1.5, 1.0, 0.5, 0.3}) bent = match.refine(bent, sigma, kSoft, 6);
  return match.halfway(pick, match.nearest_rigid(bent, 0.4));
}

}  // namespace

Alignment align(const OccupancyGrid& map, const OccupancyGrid& truth, const AlignmentConfig& config) {
  Alignment out;
  const std::vector<PoseGuess> guesses = correlate(map, truth, config.correlation);
  const WallMatch match(map, truth, config.search.reach, config.search.max_points);
  if (guesses.empty() || !match.usable()) {
    out.note = "not aligned: one of the maps has too few walls to fix a pose";
    return out;
  }
  const std::vector<Hypothesis> hypotheses = examine(guesses, match, config.search);
  const Hypothesis& best = hypotheses.front();
  out.wide_evidence = best.wide;
  out.tight_evidence = best.tight;
  out.quality = best.quality;
  out.tight = tight_agreement(best.tight);

  Rivals rivals;
  for (const Hypothesis& h : hypotheses) {
    if (same_pose(h.T_best, best.T_best, match.map_centre(), config.search.distinct_shift, config.search.distinct_turn))
      continue;
    rivals.wide = std::max(rivals.wide, h.quality);
    rivals.tight = std::max(rivals.tight, tight_agreement(h.tight));
  }
  const Trust trust = judge(best.wide, best.tight, rivals);
  out.aligned = trust.trusted;
  out.note = trust.note;
  out.runner_up = trust.runner_up;
  out.T_walls = match.refine(best.T_best, 0.1, 20);
  out.T_walls.phi = wrap_angle(out.T_walls.phi);
  out.T_truth_map = trust.tight ? out.T_walls : fit_to_the_whole(hypotheses, match, match.kernel(1.0));
  out.T_truth_map.phi = wrap_angle(out.T_truth_map.phi);
  return out;
}

}  // namespace rubble::scoring
