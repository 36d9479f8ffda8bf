#pragma once

#include "base/grid.h"
#include "base/planar.h"

namespace rubble::scoring {

/// Share of the map's known area that has nothing to do with the truth: pieces apart from everything that lies on it,
/// such as a second drawing on the same canvas. Pieces within 0.55 m of each other are one; those below a
/// tenth of what lies on the truth (legends, specks) do not count.
double detached_share(const OccupancyGrid& map, const OccupancyGrid& truth, const PlanarTransform& T_truth_map);

}  // namespace rubble::scoring
