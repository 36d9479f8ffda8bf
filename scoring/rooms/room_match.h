#pragma once

#include <mrpt/math/TPose2D.h>

#include <string>
#include <vector>

#include "scoring/rooms/rooms.h"

namespace rubble::scoring {

/// A room of the truth and its counterpart in the map.
struct RoomPair {
  std::size_t truth = 0;    ///< index in Rooms::rooms
  std::size_t map = 0;      ///< index in Rooms::rooms
  double offset = 0.0;      ///< of the centres of gravity [m]
  double area_ratio = 1.0;  ///< map over truth
  double difference = 0.0;  ///< d(f, g) of eq. (7): size, elongation, shape
  double cost = 0.0;        ///< c_ij of eq. (7) [m^2]
};

/// The score from the rooms (section IV.D): what is left of the position and shape of each room once the maps lie on
/// each other, by eq. (7) with lambda = 1 m^2 and the cap of footnote 3, C = 2 m^2.
struct RoomMatch {
  std::vector<RoomPair> pairs;       ///< in the order of the truth's rooms
  std::vector<std::size_t> missing;  ///< rooms of the truth without counterpart
  std::vector<std::size_t> surplus;  ///< rooms of the map without counterpart
  double error = 0.0;                ///< E [m^2], 0 to C
  double score = 0.0;                ///< 1 - E / C; 0 where either map has no room
};

/// The cheapest association of the rooms, each with one partner at the most.
RoomMatch match_rooms(const Rooms& map, const Rooms& truth, const mrpt::math::TPose2D& T_truth_map);

}  // namespace rubble::scoring
