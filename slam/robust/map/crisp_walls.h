#pragma once

#include "slam/grid/count_map.h"

namespace rubble::slam {

// What is no wall though it was hit: before a scan is stamped into the map, and when the map is finished.

/// Leaves out single beams that end far from both their neighbours - mixed pixels, dust, crosstalk: no wall is as
/// narrow as one beam.
void drop_lone_hits(ScanPoints& points);

/// Thins walls that fill two cells to the one that more scans have hit: a board of a centimetre or two on the border of
/// two cells is hit in either. Counted over a piece of the wall, so that walls stay straight; the other cell becomes
/// free. Walls of three cells and more stay as they are.
void thin_walls(CountMap& map);

}  // namespace rubble::slam
