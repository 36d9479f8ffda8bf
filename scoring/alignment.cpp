#include "scoring/alignment.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/angle.h"
#include "scoring/resample.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPose2D;

struct Hypothesis {
  TPose2D T_truth_map;
  PoseEvidence evidence;
  double quality = 0.0;
};

}  // namespace

Alignment align(const OccupancyGrid& map, const OccupancyGrid& truth, const AlignmentConfig& config) {
  Alignment out;
  const std::vector<PoseGuess> guesses = correlate(map, truth, config.correlation);
  if (guesses.empty()) {
    out.note = "not aligned: one of the maps has no walls";
    return out;
  }
  const WallMatch match(map, truth, config.reach, config.max_points);
  std::vector<Hypothesis> hypotheses;
  for (const PoseGuess& guess : guesses) {
    Hypothesis h;
    h.T_truth_map = match.refine(guess.T_truth_map, 1.0, 15);
    h.T_truth_map = match.refine(h.T_truth_map, 0.5, 10);
    h.T_truth_map = match.refine(h.T_truth_map, 0.25, 10);
    h.evidence = match.evidence(match.rigid(h.T_truth_map), config.tau);
    h.quality = h.evidence.map.known * (h.evidence.map.met - 0.4 - 0.5 * h.evidence.map.contradicted) +
                h.evidence.truth.known * (h.evidence.truth.met - 0.4 - 0.5 * h.evidence.truth.contradicted);
    hypotheses.push_back(h);
  }
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.quality > b.quality; });
  const Hypothesis& best = hypotheses.front();
  out.T_truth_map = match.refine(best.T_truth_map, 0.1, 20);
  out.T_truth_map.phi = wrap_angle(out.T_truth_map.phi);
  out.evidence = best.evidence;
  out.quality = best.quality;
  for (const Hypothesis& other : hypotheses) {
    const double shift =
        (best.T_truth_map.composePoint(match.map_centre()) - other.T_truth_map.composePoint(match.map_centre())).norm();
    const double turn = std::abs(wrap_angle(best.T_truth_map.phi - other.T_truth_map.phi));
    if (shift < config.correlation.distinct_shift && turn < config.correlation.distinct_turn) continue;
    out.runner_up = std::clamp(other.quality / std::max(best.quality, 1e-9), 0.0, 1.0);
    break;
  }
  out.aligned = best.quality > 0.2;
  if (!out.aligned) out.note = "not aligned: no pose makes the walls of both maps agree";
  return out;
}

}  // namespace rubble::scoring
