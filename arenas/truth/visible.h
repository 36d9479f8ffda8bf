#pragma once

#include <functional>

#include "arenas/model/arena.h"
#include "base/angle.h"
#include "base/grid.h"

namespace rubble::arenas {

/// What decides where a robot gets and how far it sees. Defaults: Pioneer 3-AT with a URG-04LX.
struct Viewer {
  double radius = 0.25;          ///< half of the body's width: what the narrowest gap must leave to either side [m]
  double height = 0.40;          ///< of the body with the laser [m]
  double laser_height = 0.35;    ///< of the laser above the floor it stands on [m]
  double climbable_step = 0.10;  ///< [m]
  double range = 4.0;            ///< of the level laser [m]
  double max_slope = deg_to_rad(22.0);  ///< steeper floor it does not drive on (data sheet of the P3-AT: 40 %) [rad]
};

/// How far the nearest thing is that the body cannot pass (solids, steps too high, floor too steep), up to 1 m; 0 where
/// the truth is not free [m]. The robot's middle can stand where that is at least the viewer's radius.
Grid<float> standing_room(const Arena& arena, const OccupancyGrid& truth, const Viewer& viewer = {});

/// Where the robot's middle can stand, reached from the start: non-zero. Cells as those of `truth`.
Grid<std::uint8_t> reachable_mask(const Arena& arena, const OccupancyGrid& truth, const Viewer& viewer = {});

/// The same from another start [m], for many starts on one floor: `room` is standing_room of this truth, or of one that
/// is free wherever this one is.
Grid<std::uint8_t> reachable_mask(const mrpt::math::TPoint2D& start, const OccupancyGrid& truth,
                                  const Grid<float>& room, const Viewer& viewer = {});

/// What a level laser could ever see from there: non-zero. Rays end at the first occupied cell, which they see, and
/// before floor that rises to the height of the laser, which is a wall to it; the edge of a floor below the laser, a
/// drop, they pass. It looks round from the start and from poses so chosen that every reachable cell is less than 0.4 m
/// from one, with rays that end a cell apart (at 8 m where the laser reaches farther). `progress` is told the share of
/// the poses that were looked from: fine grids take minutes.
Grid<std::uint8_t> visible_mask(const Arena& arena, const OccupancyGrid& truth, const Grid<std::uint8_t>& reachable,
                                const Viewer& viewer = {}, const std::function<void(double)>& progress = {});

/// The truth as far as it could ever be mapped: what no reachable pose sees becomes unknown, so that it counts against
/// no map: so does the edge of a floor that is seen from above only. So do open ground outside the walls (cells without
/// a wall somewhere in one of the four directions) farther than the range from all of them, veils, strips and gaps, and
/// 0.12 m around where rays end at floor that rises past the laser and is nowhere near what the robot reaches: a map
/// that shows a wall there and one that does not are both right.
OccupancyGrid visible_truth(const Arena& arena, const OccupancyGrid& truth, const Viewer& viewer = {},
                            const std::function<void(double)>& progress = {});

}  // namespace rubble::arenas
