#pragma once

#include <string>

#include "scoring/rooms/rooms.h"

namespace rubble::scoring {

/// Writes a PNG of the map, north up: each room in a colour of its own, walls dark, free space without a room white,
/// unknown grey; at each centre of gravity a dot and the name, around each room its box. Small maps are drawn larger.
/// Throws RunError when it cannot be written.
void write_rooms_png(const std::string& path, const OccupancyGrid& map, const Rooms& rooms);

}  // namespace rubble::scoring
