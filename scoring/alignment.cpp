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

/// A pose from the correlation, refined, and how well the maps agree there.
struct Hypothesis {
  TPose2D T_wide;  ///< rigid, walls within a metre pull: the fit to the map as a whole
  TPose2D T_best;  ///< rigid, nearest to what explains the walls best
  PoseEvidence wide;
  PoseEvidence tight;
  double quality = 0.0;
};

struct Kernels {
  WallMatch::Kernel wide;
  WallMatch::Kernel tight;
  WallMatch::Kernel metre;
};

Hypothesis examine(const WallMatch& match, const TPose2D& T_wide, const Kernels& kernels) {
  Hypothesis h;
  h.T_wide = T_wide;
  h.T_best = match.refine(match.refine(T_wide, 0.5, 8), 0.25, 8);
  h.wide = match.evidence(match.rigid(h.T_best), kernels.wide);
  h.tight = match.evidence(match.rigid(h.T_best), kernels.tight);
  h.quality = wide_agreement(h.wide);
  return h;
}

/// Takes a mild bend into account where that explains more.
void bend(Hypothesis& h, const WallMatch& match, const Kernels& kernels, double stiffness) {
  Warp bent = match.rigid(h.T_wide);
  for (const double sigma : {1.0, 0.5, 0.3})
    bent = match.refine(bent, sigma, {0.0, stiffness, stiffness, stiffness}, 5);
  const PoseEvidence wide = match.evidence(bent, kernels.wide);
  const double quality = wide_agreement(wide) - kBendCosts;
  if (quality <= h.quality) return;
  h.quality = quality;
  h.wide = wide;
  h.tight = match.evidence(bent, kernels.tight);
  h.T_best = match.nearest_rigid(bent);
}

bool same(const TPose2D& a, const TPose2D& b, const TPoint2D& centre, double shift, double turn) {
  return (a.composePoint(centre) - b.composePoint(centre)).norm() < shift && std::abs(wrap_angle(a.phi - b.phi)) < turn;
}

std::vector<Hypothesis> examine_all(const std::vector<PoseGuess>& guesses, const WallMatch& match,
                                    const Kernels& kernels, const AlignmentConfig& config) {
  const auto by_quality = [](const Hypothesis& a, const Hypothesis& b) { return a.quality > b.quality; };
  std::vector<Hypothesis> out;
  for (const PoseGuess& guess : guesses) {
    const TPose2D T_wide = match.refine(guess.T_truth_map, 1.0, 15);
    // Neighbouring peaks run into the same pose.
    const bool seen = std::any_of(out.begin(), out.end(), [&](const Hypothesis& h) {
      return same(h.T_wide, T_wide, match.map_centre(), 0.1, 0.005);
    });
    if (!seen) out.push_back(examine(match, T_wide, kernels));
  }
  std::stable_sort(out.begin(), out.end(), by_quality);
  const std::size_t bendable = std::min(out.size(), config.bent_hypotheses);
  for (std::size_t i = 0; i < bendable; ++i) bend(out[i], match, kernels, config.stiffness);
  std::stable_sort(out.begin(), out.end(), by_quality);
  return out;
}

/// Of the fits that belong to the best pose, the one with most walls within a metre and least contradicted: a bent map
/// has a pose for each of its parts, and this is the one for the whole.
TPose2D fit_to_the_whole(const std::vector<Hypothesis>& hypotheses, const WallMatch& match,
                         const WallMatch::Kernel& metre) {
  const Hypothesis& best = hypotheses.front();
  TPose2D pick = best.T_best;
  double most = whole_agreement(match.evidence(match.rigid(pick), metre));
  for (const Hypothesis& h : hypotheses) {
    if (!same(h.T_best, best.T_best, match.map_centre(), 2.5, 0.15)) continue;
    const double agreement = whole_agreement(match.evidence(match.rigid(h.T_wide), metre));
    if (agreement <= most) continue;
    most = agreement;
    pick = h.T_wide;
  }
  return pick;
}

}  // namespace

Alignment align(const OccupancyGrid& map, const OccupancyGrid& truth, const AlignmentConfig& config) {
  Alignment out;
  const std::vector<PoseGuess> guesses = correlate(map, truth, config.correlation);
  const WallMatch match(map, truth, config.reach, config.max_points);
  if (guesses.empty() || !match.usable()) {
    out.note = "not aligned: one of the maps has too few walls to fix a pose";
    return out;
  }
  const Kernels kernels{match.kernel(config.tau_wide), match.kernel(config.tau_tight), match.kernel(1.0)};
  const std::vector<Hypothesis> hypotheses = examine_all(guesses, match, kernels, config);
  const Hypothesis& best = hypotheses.front();
  out.wide_evidence = best.wide;
  out.tight_evidence = best.tight;
  out.quality = best.quality;
  out.tight = tight_agreement(best.tight);

  Rivals rivals;
  for (const Hypothesis& h : hypotheses) {
    if (same(h.T_best, best.T_best, match.map_centre(), config.correlation.distinct_shift,
             config.correlation.distinct_turn))
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
  out.T_truth_map = trust.tight ? out.T_walls : fit_to_the_whole(hypotheses, match, kernels.metre);
  out.T_truth_map.phi = wrap_angle(out.T_truth_map.phi);
  return out;
}

}  // namespace rubble::scoring
