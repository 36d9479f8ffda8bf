#pragma once

#include <mrpt/math/TPose2D.h>

#include <functional>
#include <string>
#include <vector>

#include "base/grid.h"

namespace rubble::scoring {

/// A pose of the map in the truth that something speaks for.
struct PoseGuess {
  mrpt::math::TPose2D T_truth_map;
  double score = 0.0;  ///< comparable within one list only; higher is better
  std::string source;  ///< what proposed it: "walls", "features", "rooms"
};

/// Proposes poses without any hint, best first; none where it has nothing to say. Both grids cropped to what they know.
using Proposer = std::function<std::vector<PoseGuess>(const OccupancyGrid& map, const OccupancyGrid& truth)>;

}  // namespace rubble::scoring
