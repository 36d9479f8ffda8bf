#pragma once

#include <string>

#include "arenas/model/arena.h"
#include "base/grid.h"

namespace rubble::arenas {

/// The ground-truth map: what a level laser at `slice_height` above each floor would call occupied and free.
/// Unknown: where there is no floor, and the inside of solids. `margin` of unknown cells is left around the arena.
/// Throws InputError when the map would have more than 60 million cells.
OccupancyGrid truth_map(const Arena& arena, double resolution = 0.05, double slice_height = 0.35, double margin = 0.5);

/// Its first half: all that is drawn, reachable or not. Takes the time, and does not ask where the start is.
OccupancyGrid drawn_map(const Arena& arena, double resolution = 0.05, double slice_height = 0.35, double margin = 0.5);
/// Its second half: of what is drawn what is connected with the arena's start.
OccupancyGrid around_start(const Arena& arena, OccupancyGrid drawn);

}  // namespace rubble::arenas
