#include "scoring/alignment/pose_search.h"
#include "base/planar.h"
#include "base/rigid.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "scoring/alignment/examiner.h"
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

Examiner::Examiner(const WallMatch& match, const SearchConfig& config)
    : match_(match), config_(config), wide_(match.kernel(config.tau_wide)), tight_(match.kernel(config.tau_tight)) {}

const TPose2D& Examiner::widely_refined(const TPose2D& guess) {
  for (const Refined& r : refined_)
    if (identical(r.guess, guess)) return r.T_wide;
  refined_.push_back({guess, match_.refine(guess, 1.0, 15)});
  return refined_.back().T_wide;
}

Examiner::Tried& Examiner::tried(const TPose2D& T_wide) {
  for (Tried& t : tried_)
    if (identical(t.straight.T_wide, T_wide)) return t;
  tried_.emplace_back();
  tried_.back().straight = rigid_hypothesis(match_, T_wide, {wide_, tight_});
  return tried_.back();
}

std::vector<Hypothesis> Examiner::examine(const std::vector<PoseGuess>& guesses) {
  const auto by_quality = [](const Hypothesis& a, const Hypothesis& b) { return a.quality > b.quality; };
  std::vector<Hypothesis> out;
  for (const PoseGuess& guess : guesses) {
    const TPose2D T_wide = widely_refined(guess.T_truth_map);
    // Neighbouring peaks run into the same pose.
    const auto seen = std::find_if(out.begin(), out.end(), [&](const Hypothesis& h) {
      return same_pose(h.T_wide, T_wide, match_.map_centre(), 0.1, 0.005);
    });
    if (seen != out.end()) {
      seen->by = seen->by | guess.by;
      continue;
    }
    out.push_back(tried(T_wide).straight);
    out.back().by = guess.by;
  }
  std::stable_sort(out.begin(), out.end(), by_quality);
  const std::size_t bendable = std::min(out.size(), config_.bent_hypotheses);
  for (std::size_t i = 0; i < bendable; ++i) {
    Tried& here = tried(out[i].T_wide);
    if (!here.was_bent) {
      here.bent = here.straight;
      bend(here.bent, match_, {wide_, tight_}, config_.stiffness);
      here.was_bent = true;
    }
    const AlignBy by = out[i].by;
    out[i] = here.bent;
    out[i].by = by;
  }
  std::stable_sort(out.begin(), out.end(), by_quality);
  return out;
}

std::vector<Hypothesis> examine(const std::vector<PoseGuess>& guesses, const WallMatch& match,
                                const SearchConfig& config) {
  return Examiner(match, config).examine(guesses);
}

}  // namespace rubble::scoring
