#pragma once

#include <utility>
#include <vector>

#include "base/grid.h"

namespace rubble::scoring {

/// Cells between which a wall askew to the raster broke into dashes: pairs of the nearest cells of two connected pieces
/// (8 neighbours) that stand end to end on one line with a third, 0.35 m long or more. The gaps are 0.13 m at the most
/// and a quarter of the line together, every cell lies within 0.06 m of it, and nothing else stands within 0.25 m
/// beside the gaps. Salt lies in no line, and what stands beside it gives it away. `most_work`: cells looked at; none
/// are found where more would be, as in pictures of a millimetre a cell that are full of strokes.
std::vector<std::pair<Cell, Cell>> dashes_in_line(const OccupancyGrid& grid, double most_work = 2e9);

}  // namespace rubble::scoring
