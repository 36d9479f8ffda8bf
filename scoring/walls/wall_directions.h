#pragma once

#include <vector>

#include "base/grid.h"

namespace rubble::scoring {

/// How much wall of a map runs in which direction: a histogram over [0, pi), smoothed by a few degrees. All 0 without
/// walls. The direction at a wall cell is the main axis of the walls in a window of 1 m around it.
std::vector<double> wall_directions(const OccupancyGrid& grid, int bins);

/// Which rotations of the map, of `half_rotations` over [0, pi), bring its wall directions onto the truth's: their
/// correlation lies above the mean by at least `share` of the highest rise. All where no rotation stands out. A turn by
/// pi more is as plausible.
std::vector<bool> plausible_rotations(const OccupancyGrid& map, const OccupancyGrid& truth, int half_rotations,
                                      double share);

}  // namespace rubble::scoring
