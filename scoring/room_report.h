#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <string>

#include "base/grid.h"
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
  RoomMatch match;
  mrpt::math::TPose2D T_truth_map;
};

/// `T_truth_map`: the pose, where it is known; else it is searched.
RoomVerdict judge_rooms(const OccupancyGrid& map, const Rooms& of_map, const OccupancyGrid& truth,
                        const Rooms& of_truth, const std::optional<mrpt::math::TPose2D>& T_truth_map = {});

}  // namespace rubble::scoring
