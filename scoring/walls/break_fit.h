#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <vector>

#include "base/grid.h"

namespace rubble::scoring {

/// A map that came apart where a loop was not closed: two rigid parts on the two sides of a straight seam.
struct MapBreak {
  bool found = false;
  mrpt::math::TPoint2D p_seam;  ///< a point of the seam, map frame [m]
  double normal = 0.0;          ///< direction across the seam, from the first part to the second, map frame [rad]
  mrpt::math::TPose2D T_truth_first;
  mrpt::math::TPose2D T_truth_second;
  double apart_m = 0.0;       ///< what the two poses make of the seam's middle [m]
  double turned_rad = 0.0;    ///< of the second part against the first
  mrpt::math::TPoint2D from;  ///< ends of the seam within the map, as the larger part places them: truth frame [m]
  mrpt::math::TPoint2D to;
};

/// Looks for the seam, of any direction and place, on whose sides the map's walls meet the truth's best once each side
/// may move by itself. Not found where one pose explains as much, where a part holds less than 15 % of the walls, or
/// where the parts are less than 8 cm and 0.8 deg apart.
MapBreak find_break(const OccupancyGrid& map, const OccupancyGrid& truth, const mrpt::math::TPose2D& T_truth_map);

/// The map with both parts where they belong, in the truth's frame. Where parts overlap, walls win.
OccupancyGrid mended(const OccupancyGrid& map, const OccupancyGrid& truth, const MapBreak& seam);

}  // namespace rubble::scoring
