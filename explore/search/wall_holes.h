#pragma once

#include <mrpt/math/TPoint2D.h>

#include <vector>

#include "base/grid.h"
#include "explore/plan/traversable.h"

namespace rubble::explore {

constexpr double kWidestHole = 0.20;  ///< in a wall [m]

/// A hole in a straight wall, as the scanner's plane has met it.
struct WallHole {
  mrpt::math::TPoint2D p_map;  ///< [m]
  Cell along;                  ///< step of one cell along its wall: (1, 0) or (0, 1)
};

/// The gaps of at most kWidestHole in straight walls. A piece of wall that a good part of the scans passed
/// (`Traversable::unsure`) is a gap as well: from a ramp beside it the plane goes over a hole or below.
std::vector<WallHole> wall_holes(const Traversable& floor);

/// Whether a place lies along the wall of such a hole, no farther from it than boards with holes have them apart.
bool beside_hole(const std::vector<WallHole>& holes, const mrpt::math::TPoint2D& place, Cell along);

}  // namespace rubble::explore
