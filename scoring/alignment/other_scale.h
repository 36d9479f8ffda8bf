#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <vector>

#include "base/grid.h"
#include "scoring/measures/sight_lines.h"

namespace rubble::scoring {

/// How many times as large the map would have to be for its walls to meet the truth's near this pose, at 0.7 to 1.4
/// times `about`: where it has a good score so, and a much better one than `score`; nothing else is said.
/// `T_truth_map`: of the map at `about` times its size.
std::optional<double> better_scale(const OccupancyGrid& map, const OccupancyGrid& truth,
                                   const mrpt::math::TPose2D& T_truth_map, const SightLines& sights, double score,
                                   double about = 1.0);

/// Sizes at which the map would have as much free ground as the truth, or lie in a box as large: of maps that hold the
/// whole arena one of them is about right. None that is nearly 1, nor two that are alike.
std::vector<double> sizes_by_extent(const OccupancyGrid& map, const OccupancyGrid& truth);

}  // namespace rubble::scoring
