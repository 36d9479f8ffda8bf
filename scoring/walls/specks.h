#pragma once

#include "base/grid.h"

namespace rubble::scoring {

/// The map without its specks: one or two occupied cells that touch each other only, with at most two more occupied
/// cells within 0.2 m. They become what most cells around them are. Where specks are most of what is occupied, they are
/// the map's way of drawing walls, and it is returned as it is. For finding a pose only: a score counts every wall.
OccupancyGrid without_specks(const OccupancyGrid& map);

}  // namespace rubble::scoring
