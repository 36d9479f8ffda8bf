#pragma once

#include <vector>

#include "scoring/proposals/pose_guess.h"

namespace rubble::scoring {

struct CorrelationConfig {
  double cell = 0.4;              ///< edge of a correlation cell [m]
  double reach = 0.8;             ///< a wall counts as met when it is nearer than this, fading linearly [m]
  double rotation_step = 0.035;   ///< [rad]
  double direction_share = 0.45;  ///< rotations that bring wall directions together less well than this are left out
  int peaks_per_rotation = 6;     ///< local maxima kept of each rotation
  int guesses = 24;               ///< distinct poses returned
  double distinct_shift = 1.2;    ///< poses nearer than this ...
  double distinct_turn = 0.10;    ///< ... and turned by less are the same [m, rad]
  double wall_on_wall = 1.0;      ///< what a pair of cells says for (or against) a pose
  double wall_on_free = -0.7;
  double free_on_wall = -0.35;
  double free_on_free = 0.12;
};

/// Scores every shift of `map` over `truth`, at every rotation that brings the walls' directions together, by FFT
/// correlation of walls, free space and their conflicts, and returns the best distinct poses, best first. Cells unknown
/// to either side say nothing. Empty when one map has no wall.
std::vector<PoseGuess> correlate(const OccupancyGrid& map, const OccupancyGrid& truth,
                                 const CorrelationConfig& config = {});

}  // namespace rubble::scoring
