#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "scoring/rooms/passages.h"
#include "scoring/rooms/room_floor.h"

namespace rubble::scoring {

/// Rooms as a label image (CV_32S): 0 none, else 1 to `count`.
struct RoomRegions {
  cv::Mat labels;
  int count = 0;
  std::vector<Passage> doors;  ///< passages with another room on either side
};

/// What the passages separate; regions that are too small joined to a neighbour.
RoomRegions separate(const RoomFloor& floor, const std::vector<Passage>& passages, const RoomConfig& config);

/// Gives the floor that was closed or cleared in the making (slits, passages, furniture) to the nearest room.
void grow_regions(RoomRegions& regions, const RoomFloor& floor);

/// Gives furniture that stands at a wall to the room around it: obstacles inside the convex hull of a room that are
/// neither too deep nor too large. Walls between rooms are thinner or lie outside the hull.
void fill_niches(RoomRegions& regions, const RoomFloor& floor, const RoomConfig& config);

}  // namespace rubble::scoring
