#pragma once

#include <string>

#include "base/grid.h"

namespace rubble::scoring {

struct Rooms;

/// Writes a PNG of the map, north up: each room in a colour of its own, walls dark, free space without a room white,
/// unknown grey; in each room its name, around it its box, at its centre of gravity, which may lie elsewhere, a ring in
/// its colour; axes in metres of the map, legend and scale. Small maps are drawn larger. Throws RunError when it cannot
/// be written.
void write_rooms_png(const std::string& path, const OccupancyGrid& map, const Rooms& rooms);

}  // namespace rubble::scoring
