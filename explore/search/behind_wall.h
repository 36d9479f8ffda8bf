#pragma once

#include <mrpt/math/TPoint2D.h>

#include "base/grid.h"
#include "slam/grid/count_map.h"

namespace rubble::explore {

/// Whether a wall of the map stands between two places, and the second is not before it or in its cells [m].
bool is_behind_wall(const OccupancyGrid& cells, const mrpt::math::TPoint2D& from, const mrpt::math::TPoint2D& to);

/// The same, and not past the edge of that wall: seen aslant, the side of a box covers what lies in it on the map, by a
/// cell or by the error of the place, and a hand beside the line there is no wall.
bool is_within_wall(const OccupancyGrid& cells, const mrpt::math::TPoint2D& from, const mrpt::math::TPoint2D& to);

/// Whether the second place lies in a box behind a wall, and was seen from the first through a hole: right behind what
/// is long and straight enough for a wall. The side of a box, a step and a scrap of the floor of a slope are shorter.
/// `shut`: the map with_holes_shut, for the scanner may have seen the hole. `counts` of it: the wall must have been hit
/// by nearly all scans that looked there. One that the map shows twice, or that is the floor of a slope, is not.
bool is_behind_hole(const OccupancyGrid& shut, const slam::CountMap* counts, const mrpt::math::TPoint2D& from,
                    const mrpt::math::TPoint2D& to);
/// The same on a map whose holes are open, however often its walls were hit.
bool shows_through_hole(const OccupancyGrid& cells, const mrpt::math::TPoint2D& from, const mrpt::math::TPoint2D& to);

}  // namespace rubble::explore
