#pragma once

#include <mrpt/math/TPose2D.h>

#include <string>

#include "base/grid.h"
#include "scoring/correlation.h"
#include "scoring/pose_search.h"
#include "scoring/wall_match.h"

namespace rubble::scoring {

struct AlignmentConfig {
  CorrelationConfig correlation;
  SearchConfig search;
};

/// The rigid transform between two maps, found without any initial guess.
struct Alignment {
  bool aligned = false;             ///< the transform can be trusted
  std::string note;                 ///< why not; one line
  mrpt::math::TPose2D T_truth_map;  ///< the best pose found, also when it cannot be trusted
  mrpt::math::TPose2D T_walls;      ///< the same, drawn to where most walls coincide; equal for undistorted maps
  double runner_up = 0.0;           ///< quality of the best clearly different pose relative to the best, 0..1
  double quality = 0.0;             ///< wide agreement of both maps' walls at the best pose; 1.2 at the most
  double tight = 0.0;               ///< tight, chance-corrected agreement at the best pose; 2 at the most
  PoseEvidence wide_evidence;
  PoseEvidence tight_evidence;
};

/// Correlation of walls and free space over all rotations and shifts; the best hypotheses refined on the distance
/// fields and ranked by what the walls of both maps say about each other, after a mild bend of the map where that
/// explains more. Scale is fixed at 1, mirror images are never tried. docs/scoring.md gives the rules of trust.
Alignment align(const OccupancyGrid& map, const OccupancyGrid& truth, const AlignmentConfig& config = {});

}  // namespace rubble::scoring
