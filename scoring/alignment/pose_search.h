#pragma once

#include <string>
#include <vector>

#include "scoring/proposals/pose_guess.h"
#include "scoring/walls/wall_match.h"

namespace rubble::scoring {

struct SearchConfig {
  double reach = 2.0;               ///< walls further apart than this do not pull on each other [m]
  std::size_t max_points = 800;     ///< wall points of each map used to refine the hypotheses
  double tau_tight = 0.3;           ///< k(d) of the agreement that tells right from almost right [m]
  double tau_wide = 0.6;            ///< k(d) of the agreement that ranks poses [m]
  std::size_t bent_hypotheses = 8;  ///< of the best poses, those that may bend the map
  double stiffness = 0.003;         ///< holds back the quadratic displacement of the check
  double distinct_shift = 1.2;      ///< poses nearer than this, or than ...
  double distinct_share = 0.04;     ///< ... this share of the map's extent (the parts of a bent map have their own) ...
  double distinct_turn = 0.10;      ///< ... and turned by less are the same [m, rad]
};

/// A proposed pose, refined, and how well the maps agree there.
struct Hypothesis {
  mrpt::math::TPose2D T_wide;  ///< rigid, walls within a metre pull: the fit to the map as a whole
  mrpt::math::TPose2D T_best;  ///< rigid, nearest to what explains the walls best
  PoseEvidence wide;
  PoseEvidence tight;
  double quality = 0.0;        ///< wide agreement, at most 1.2
  AlignBy by = AlignBy::Auto;  ///< all that proposed it
};

/// Refines the guesses on the distance fields of both maps, drops those that run into the same pose, and ranks the rest
/// by what the walls of both maps say about each other, after a mild bend of the map where that explains more.
std::vector<Hypothesis> examine(const std::vector<PoseGuess>& guesses, const WallMatch& match,
                                const SearchConfig& config);

}  // namespace rubble::scoring
