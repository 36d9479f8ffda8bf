#pragma once

#include <mrpt/math/TPose2D.h>

#include <string>

#include "base/grid.h"
#include "scoring/correlation.h"
#include "scoring/wall_match.h"

namespace rubble::scoring {

struct AlignmentConfig {
  CorrelationConfig correlation;
  double reach = 2.0;             ///< walls further apart than this do not pull on each other [m]
  std::size_t max_points = 1500;  ///< wall points of each map used to refine the hypotheses
  double tau = 0.6;               ///< distance at which a wall no longer counts as met when poses are ranked [m]
};

/// The rigid transform between two maps, found without any initial guess.
struct Alignment {
  bool aligned = false;             ///< the transform can be trusted
  std::string note;                 ///< why not; one line
  mrpt::math::TPose2D T_truth_map;  ///< the best pose found, also when it cannot be trusted
  double quality = 0.0;             ///< of the best pose
  double runner_up = 0.0;           ///< quality of the best clearly different pose relative to the best, 0..1
  PoseEvidence evidence;            ///< at the best pose
};

/// Correlation of walls and free space over all rotations and shifts, the best hypotheses refined on the distance
/// fields and ranked by what both maps say about each other. Scale is fixed at 1, mirror images are never tried.
Alignment align(const OccupancyGrid& map, const OccupancyGrid& truth, const AlignmentConfig& config = {});

}  // namespace rubble::scoring
