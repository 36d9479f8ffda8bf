#include "scoring/alignment/pose_search.h"
#include "base/rigid.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "scoring/alignment/trust.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kMaxStrain = 0.08;  // a map that is stretched by more is of another scale

struct Kernels {
  WallMatch::Kernel wide;
  WallMatch::Kernel tight;
};

Hypothesis rigid_hypothesis(const WallMatch& match, const TPose2D& T_wide, const Kernels& kernels) {
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
  if (bent.strain() > kMaxStrain) return;
  const PoseEvidence wide = match.evidence(bent, kernels.wide);
  const double quality = wide_agreement(wide) - kBendCosts;
  if (quality <= h.quality) return;
  h.quality = quality;
  h.wide = wide;
  h.tight = match.evidence(bent, kernels.tight);
  h.T_best = match.nearest_rigid(bent);
}

}  // namespace

std::vector<Hypothesis> examine(const std::vector<PoseGuess>& guesses, const WallMatch& match,
                                const SearchConfig& config) {
  const Kernels kernels{match.kernel(config.tau_wide), match.kernel(config.tau_tight)};
  const auto by_quality = [](const Hypothesis& a, const Hypothesis& b) { return a.quality > b.quality; };
  std::vector<Hypothesis> out;
  for (const PoseGuess& guess : guesses) {
    const TPose2D T_wide = match.refine(guess.T_truth_map, 1.0, 15);
    // Neighbouring peaks run into the same pose.
    const auto seen = std::find_if(out.begin(), out.end(), [&](const Hypothesis& h) {
      return same_pose(h.T_wide, T_wide, match.map_centre(), 0.1, 0.005);
    });
    if (seen != out.end()) {
      seen->by = seen->by | guess.by;
      continue;
    }
    out.push_back(rigid_hypothesis(match, T_wide, kernels));
    out.back().by = guess.by;
  }
  std::stable_sort(out.begin(), out.end(), by_quality);
  const std::size_t bendable = std::min(out.size(), config.bent_hypotheses);
  for (std::size_t i = 0; i < bendable; ++i) bend(out[i], match, kernels, config.stiffness);
  std::stable_sort(out.begin(), out.end(), by_quality);
  return out;
}

}  // namespace rubble::scoring
