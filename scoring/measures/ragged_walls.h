#pragma once

#include <opencv2/core/mat.hpp>
#include <utility>
#include <vector>

#include "base/grid.h"

namespace rubble::scoring {

/// Cells between which a wall that wavers broke: dots and strokes that fill a band 0.2 m wide along 0.35 m of a line,
/// in any direction. Pairs of a cell that `is_small` marks (non-zero) and a wall cell ahead of it in the band, of each
/// column the one nearest to the line. Next to nothing stands within 0.15 m beside the band: so salt is mostly left as
/// it is. None are found where more than 2e8 cells would be looked at, as in fine pictures that are full of specks.
std::vector<std::pair<Cell, Cell>> ragged_walls(const OccupancyGrid& grid, const cv::Mat& is_small);

}  // namespace rubble::scoring
