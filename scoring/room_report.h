#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <string>

#include "base/grid.h"
#include "scoring/marks.h"
#include "scoring/rooms/room_match.h"
#include "scoring/rooms/rooms.h"

namespace rubble::scoring {

/// The rooms of a map; `by_sight`: as clusters of wall control points (section IV.E), else by passages.
Rooms rooms_of_map(const OccupancyGrid& map, bool by_sight);

/// Draws them as a PNG. Throws RunError.
void draw_rooms(const std::string& path, const OccupancyGrid& map, const Rooms& rooms);

/// The rooms of a map held against those of the truth.
struct RoomVerdict {
  bool aligned = false;  ///< without a pose that can be trusted nothing is compared
  std::string note;      ///< why not
  Rooms of_map;          ///< as they were compared; where they lie is not known: by themselves
  RoomMatch match;
  mrpt::math::TPose2D T_truth_map;
};

/// `T_truth_map`: the pose, where it is known; else it is that at which score_map() scores. The map's rooms are divided
/// as the truth's where both have the same walls, but for those `by_sight`.
RoomVerdict judge_rooms(const OccupancyGrid& map, const OccupancyGrid& truth, const Rooms& of_truth, bool by_sight,
                        const std::optional<mrpt::math::TPose2D>& T_truth_map = {});

/// What pages and pictures show of the rooms of a map that was scored at this pose: the same by passages.
Marks room_marks(const OccupancyGrid& map, const OccupancyGrid& truth, const Rooms& of_truth,
                 const mrpt::math::TPose2D& T_truth_map);

}  // namespace rubble::scoring
