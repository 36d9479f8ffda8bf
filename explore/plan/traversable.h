#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <vector>

#include "base/grid.h"
#include "slam/grid/count_map.h"

namespace rubble::explore {

/// The floor as the planner sees it: the known part of the map with a rim of unknown cells around it.
struct Traversable {
  OccupancyGrid cells;
  Grid<std::uint8_t> obstacle;  ///< 1 where something must be kept away from
  /// 1 where a good part of the scans hit something and the others pass: what is lower than the scan's plane from the
  /// floor around, as a victim's box beside a ramp is. Free to drive as far as the map tells, but not to look through.
  Grid<std::uint8_t> seen_over;
  /// 1 at walls that a good part of the scans passed: the floor of a slope, which they meet elsewhere with each degree
  /// of tilt, things that rolled away, and walls that the map shows twice.
  Grid<std::uint8_t> unsure;
  Grid<std::uint8_t> solid;    ///< 1 where something was met from so near that it is no floor of a slope
  Grid<std::uint8_t> scans;    ///< so many scans saw the cell, 255 at the most; 0 everywhere: nobody knows
  Grid<std::uint8_t> body;     ///< 1 where no scan has looked, but the robot's body stands or stood: free, no frontier
  Grid<float> clearance;       ///< distance to the nearest obstacle [m], capped; empty until measure_clearance
  std::vector<Cell> doubtful;  ///< made free as what may be the floor of a slope
  std::vector<Cell> loose;     ///< made free as what can be pushed aside, lies on the trail, or is no wall

  const GridFrame& frame() const { return cells.frame(); }
};

/// Takes an occupancy grid whose outermost cells are unknown; every occupied cell is an obstacle.
Traversable traversable(OccupancyGrid known);

/// Cuts the known part out of the map, one unknown cell around it; a 0 x 0 grid when nothing was seen yet.
/// Lone weak cells (hit at most twice, nothing else occupied within 0.15 m) are mixed pixels or noise more often than
/// things: the robot does not drive over them, but they are no obstacles to keep away from. `low_walls`: tells what is
/// `seen_over`; else nothing is.
Traversable traversable(const slam::CountMap& map, double occupied_threshold, bool low_walls = false);

/// Makes the cells below the robot's body free: it stands there. `reach` widens the body on every side [m].
void free_body(Traversable& floor, const mrpt::math::TPose2D& T_map_base, double length, double width, double reach);

/// Makes unknown cells within `radius` of a place the robot's centre has passed free.
void free_trail(Traversable& floor, const std::vector<mrpt::math::TPoint2D>& trail, double radius);

/// Makes free cells farther than `radius` from all places the robot's centre has passed unknown: ways then lead over
/// floor that has carried it.
void keep_to_trail(Traversable& floor, const std::vector<mrpt::math::TPoint2D>& trail, double radius);

/// Makes free what lies within `radius` of a place the robot's centre has passed: it was not there then, or it is none.
void loosen_trail(Traversable& floor, const std::vector<mrpt::math::TPoint2D>& trail, double radius);

/// Where the robot drove it fits again: lifts the clearance of what is no obstacle along the lines between these
/// places, a cell and a half to either side, to `clearance` [m]. Not within that of `things`, which were met since.
/// Places more than half a metre apart are not one way.
void widen_trail(Traversable& floor, const std::vector<mrpt::math::TPoint2D>& trail, double clearance,
                 const std::vector<mrpt::math::TPoint2D>& things);

/// Adds obstacles the map does not show (yet), e.g. the hits of the newest scan. A point within `near` of an obstacle
/// of the map is taken for that obstacle, displaced by the error of the pose, and left out.
void add_obstacles(Traversable& floor, const std::vector<mrpt::math::TPoint2D>& points, double near);

/// Fills the clearance from the obstacles, capped at `cap` [m].
void measure_clearance(Traversable& floor, double cap);

}  // namespace rubble::explore
