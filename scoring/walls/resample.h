#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <vector>

#include "base/grid.h"

namespace rubble::scoring {

/// The smallest frame, on the lattice of `grid`, that holds its known cells and `margin` [m] around them; nothing when
/// no cell is known.
std::optional<GridFrame> known_frame(const OccupancyGrid& grid, double margin);

/// The part of `grid` inside its known frame. A grid without a known cell is returned as it is.
OccupancyGrid crop_to_known(const OccupancyGrid& grid, double margin);

/// The grid seen in a mirror: east and west exchanged, same frame.
OccupancyGrid mirror_image(const OccupancyGrid& grid);

/// The map drawn so many times as large; the corner of its frame stays.
OccupancyGrid at_size(const OccupancyGrid& map, double times);
/// `middle` times powers of `step`, from -steps to steps: sizes to try, the smallest first.
std::vector<double> sizes_about(double middle, double step, int steps);

/// The frame on the lattice of `truth` that holds the known cells of `truth` and those of the moved `map`. It does not
/// depend on how much unknown canvas lies around either.
GridFrame common_frame(const OccupancyGrid& map, const OccupancyGrid& truth, const mrpt::math::TPose2D& T_truth_map,
                       double margin);

/// `map` seen in `frame`: each cell takes the class of the map cell under its centre; walls of a finer map are never
/// skipped. Outside the map: unknown.
OccupancyGrid resample(const OccupancyGrid& map, const mrpt::math::TPose2D& T_frame_map, const GridFrame& frame);

}  // namespace rubble::scoring
