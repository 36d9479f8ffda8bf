#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <optional>
#include <string>

#include "base/grid.h"
#include "base/image/geotiff.h"

namespace rubble::explore {

/// Of the Exploration Transform over a map; the defaults are those of the explorer.
struct PlanPictureConfig {
  double alpha = 0.0;          ///< weight of the discomfort against length
  double d_min = 0.0;          ///< never nearer to obstacles [m]
  double d_opt = 0.0;          ///< the distance that is liked best [m]
  bool per_cell = false;       ///< the discomfort summed per cell, as eq. (3) is printed; else per metre
  int min_frontier_cells = 0;  ///< smaller frontiers are no targets
  PlanPictureConfig();
};

/// A way to a frontier.
struct PlannedWay {
  double length = 0.0;           ///< [m]
  double cost = 0.0;             ///< of eq. (3) [m]
  double least_clearance = 0.0;  ///< [m]
};

struct PlanPicture {
  /// Fig. 9 of the paper: the nearer to a frontier the darker, white where none can be reached; walls black, unknown
  /// grey-blue, frontiers blue, the way red. A pixel a cell, one cell of unknown around the map.
  RgbImage image;
  std::size_t frontiers = 0;
  std::optional<PlannedWay> way;  ///< from the place asked for; nothing: no frontier can be reached from there
};

/// Runs the Exploration Transform over `map`, with the way from `from` [m] if that is given.
/// Throws InputError: no frontier; `from` is not on free floor, or nearer to obstacles than d_min.
PlanPicture plan_picture(const OccupancyGrid& map, const PlanPictureConfig& config,
                         const std::optional<mrpt::math::TPoint2D>& from);

}  // namespace rubble::explore
