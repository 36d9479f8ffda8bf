#pragma once

#include <opencv2/core.hpp>

#include "base/grid.h"
#include "scoring/rooms/room_config.h"

namespace rubble::scoring {

/// Where one can stand, as masks (255: yes), row 0 in the south as in the grid.
struct RoomFloor {
  cv::Mat free;              ///< the map's free cells
  cv::Mat cleared;           ///< the same without small furniture
  cv::Mat open;              ///< the same with slits closed; its rim is closed as well
  double resolution = 0.05;  ///< [m]
};

RoomFloor room_floor(const OccupancyGrid& map, const RoomConfig& config);

}  // namespace rubble::scoring
