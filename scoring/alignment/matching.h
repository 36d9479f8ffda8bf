#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scoring/proposals/features.h"
#include "scoring/proposals/pose_guess.h"

namespace rubble::scoring {

struct MatchConfig {
  std::size_t neighbours = 2;     ///< most similar features of the truth that each feature of the map may stand for
  std::size_t max_matches = 800;  ///< of all, the most distinctive
  double max_size_ratio = 1.5;    ///< features of maps of one scale have one size
  double least_baseline = 2.0;    ///< between the two matches of a draw [m]
  double stretch = 0.5;           ///< by which their distances may differ between the maps [m]
  double twist = 0.35;            ///< by which their directions and the rotation may differ [rad]
  double inlier = 0.5;            ///< a match within this distance supports a pose [m]
  std::size_t least_inliers = 6;  ///< below, a pose is chance
  int draws = 6000;
  std::size_t guesses = 12;  ///< poses proposed
  std::uint64_t seed = 1;
};

/// A feature of the map that may be a feature of the truth, w_ij = 1 of eq. (7).
struct Match {
  std::size_t map = 0;
  std::size_t truth = 0;
  double distance = 0.0;  ///< of the descriptors
  double ratio = 1.0;     ///< to the distance of the next candidate: small is distinctive
};

/// Associates by descriptors only, section IV.F step 1: not only the best but reasonably good candidates, most
/// distinctive first.
std::vector<Match> associate(const FeatureSet& map, const FeatureSet& truth, const MatchConfig& config = {});

/// Section IV.F step 2: poses by least squares from guessed associations. Draws pairs of matches, distinctive ones
/// first (PROSAC, Chum 2005), and fits the pose at scale 1 to all matches that agree. Score: their number.
std::vector<PoseGuess> poses_from(const FeatureSet& map, const FeatureSet& truth, const std::vector<Match>& matches,
                                  const MatchConfig& config = {});

/// The two steps for one kind of feature.
std::vector<PoseGuess> propose_by_features(const OccupancyGrid& map, const OccupancyGrid& truth, FeatureKind kind,
                                           const MatchConfig& config = {});

}  // namespace rubble::scoring
