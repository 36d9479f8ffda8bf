#pragma once

#include <cstdint>

#include "base/grid.h"
#include "base/trajectory.h"

namespace rubble::scoring {

/// How many rooms of an arena a robot could have entered, and how many of these it did.
struct RoomsEntered {
  std::uint64_t reachable = 0;
  std::uint64_t entered = 0;
};

/// Rooms as the truth map's passages separate them (scoring/rooms). One is reachable where the robot's middle can stand
/// on a quarter of a square metre of it (`reachable`, cells of the truth), and was entered when its middle was there.
/// `path`: poses of the base in the frame of `truth`.
RoomsEntered rooms_entered(const OccupancyGrid& truth, const Grid<std::uint8_t>& reachable, const Trajectory& path);

}  // namespace rubble::scoring
