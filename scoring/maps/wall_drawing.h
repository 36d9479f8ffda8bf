#pragma once

#include <string>

#include "base/grid.h"

namespace rubble::scoring {

/// Said of walls that enclose nothing: a doubt about what was read.
inline constexpr const char* kFreeNotKnown = "free space is not known";

/// Drawings (CAD, a plan in a paint program) know two kinds of cells: walls and the rest. What the rest means is told
/// by flooding from the rim; slits in walls up to 0.2 m hold the flood.
struct FloodedDrawing {
  OccupancyGrid grid;
  std::string note;  ///< what was decided, for people; empty: the map knows free and unknown cells, nothing was changed
};

/// Walls without free space: what they enclose becomes free. Free space without unknown, and all around the walls: what
/// lies outside of them becomes unknown, if they enclose a fifth of it or more.
FloodedDrawing flood_drawing(OccupancyGrid grid);

}  // namespace rubble::scoring
