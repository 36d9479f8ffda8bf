#pragma once

#include <mrpt/math/TPose2D.h>

#include <string>

#include "base/grid.h"

namespace rubble::scoring {

/// A PNG of where the map is right about the truth's lines of sight, of which the score is made, and where it is not:
/// tiles of 0.15 m and more, green where lines are answered rightly, red as far as the map draws walls where the way is
/// open, blue as far as it lacks or displaces the walls that block them, yellow as far as it does not know. Tiles that
/// no line asks about are white. The truth's walls are dark, those that only the map has grey.
std::string sight_map_png(const OccupancyGrid& map, const OccupancyGrid& truth, const mrpt::math::TPose2D& T_truth_map);
/// Throws RunError when it cannot be written.
void write_sight_map(const std::string& path, const OccupancyGrid& map, const OccupancyGrid& truth,
                     const mrpt::math::TPose2D& T_truth_map);

}  // namespace rubble::scoring
