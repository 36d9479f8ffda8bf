#pragma once

#include "base/grid.h"
#include "base/planar.h"

namespace rubble::scoring {

/// Share of the map's known area that nobody can have seen: it lies more than 0.5 m outside a truth that walls close
/// all around, a tenth and more of what lies on the truth lies even 2 m outside it (a map that came apart hardly
/// reaches so far), and it has inner walls, as an arena has and a hall has not. 0 of a truth with a way out wider than
/// 0.2 m.
double share_beyond_walls(const OccupancyGrid& map, const OccupancyGrid& truth, const PlanarTransform& T_truth_map);

}  // namespace rubble::scoring
