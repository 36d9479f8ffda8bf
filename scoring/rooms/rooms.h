#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <array>
#include <cstdint>
#include <vector>

#include "base/grid.h"
#include "scoring/rooms/room_config.h"

namespace rubble::scoring {

struct RoomFloor;

/// One room of a map: the feature of section IV.D. Nothing in it but `centre`, the box and `direction` depends on the
/// frame.
struct Room {
  mrpt::math::TPoint2D centre;   ///< centre of gravity [m]
  mrpt::math::TPoint2D box_min;  ///< axis-parallel bounding box [m]
  mrpt::math::TPoint2D box_max;
  double area = 0.0;              ///< [m^2]
  double perimeter = 0.0;         ///< of the outline, holes left out [m]
  double elongation = 1.0;        ///< long over short standard deviation of the area
  double direction = 0.0;         ///< of the long axis, in (-pi/2, pi/2] [rad]
  std::array<double, 4> shape{};  ///< Hu's first moment and the roots of the next three: all of one order
};

/// Where a room ends in another one: a line between two points of the walls [m].
struct RoomDoor {
  mrpt::math::TPoint2D a;
  mrpt::math::TPoint2D b;
};

struct Rooms {
  std::vector<Room> rooms;        ///< largest first
  std::vector<RoomDoor> doors;    ///< none of clusters (RoomMethod::Visibility)
  bool too_many_corners = false;  ///< more than RoomConfig::most_corners: not looked for
  Grid<std::uint16_t> labels;     ///< 0: no room; k: rooms[k - 1]. Cells of the map, or coarser: RoomConfig::finest
};

/// Finds the rooms of a map (section IV.E). Unknown cells count as walls. A map without free cells has no rooms.
Rooms extract_rooms(const OccupancyGrid& map, const RoomConfig& config = {});

/// The same, where room_floor() of the map is there already.
Rooms extract_rooms(const OccupancyGrid& map, const RoomFloor& floor_of_map, const RoomConfig& config = {});

/// The rooms of a map, divided as those of `truth` wherever both maps have the same walls: else openings that are
/// nearly doors, or rooms that are nearly too small, would be divided one way here and the other way there by a
/// centimetre of wall. A door of the truth is one of the map where walls stand at both its ends; an opening that the
/// truth has as well and does not take for a door is none. By passages, whatever `config` says.
Rooms extract_rooms_as(const OccupancyGrid& map, const Rooms& truth, const mrpt::math::TPose2D& T_truth_map,
                       const RoomConfig& config = {});

/// What distinguishes two rooms apart from where they lie: d(f, g) of eq. (7). 0 for equal rooms, symmetric.
double room_difference(const Room& f, const Room& g);

}  // namespace rubble::scoring
