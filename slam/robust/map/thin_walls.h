#pragma once

#include "slam/grid/count_map.h"

namespace rubble::slam {

/// Thins walls that fill two cells to the one that more scans have hit: a board of a centimetre or two on the border of
/// two cells is hit in either. Counted over a piece of the wall, so that walls stay straight; the other cell becomes
/// free. Walls of three cells and more stay as they are.
void thin_walls(CountMap& map);

}  // namespace rubble::slam
