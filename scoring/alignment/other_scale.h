#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>

#include "base/grid.h"
#include "scoring/measures/sight_lines.h"

namespace rubble::scoring {

/// How many times as large (0.7 to 1.4) the map would have to be for its walls to meet the truth's near this pose:
/// where it has a good score so, and a much better one than `score`; nothing else is said.
std::optional<double> better_scale(const OccupancyGrid& map, const OccupancyGrid& truth,
                                   const mrpt::math::TPose2D& T_truth_map, const SightLines& sights, double score);

}  // namespace rubble::scoring
