#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <optional>
#include <string>

#include "base/grid.h"
#include "explore/plan/planner.h"

namespace rubble::explore {

/// A way to a frontier, or to the place asked for.
struct PlannedWay {
  double length = 0.0;           ///< [m]
  double cost = 0.0;             ///< of eq. (3) [m]
  double least_clearance = 0.0;  ///< [m]
};

struct PlanPicture {
  /// Fig. 9 of the paper: the nearer to a frontier the darker, white where none can be reached; walls black, unknown
  /// grey-blue, frontiers blue, the way red; discs where it starts (green) and ends (blue, as the target). One cell of
  /// unknown around the map; axes in its metres, legend and scale.
  std::string png;  ///< the bytes of the file
  double pixels_per_metre = 0.0;
  std::size_t frontiers = 0;
  bool reached = false;           ///< some floor has a way to a frontier or to the target
  std::optional<PlannedWay> way;  ///< from the place asked for; nothing: none can be reached from there
};

/// The ends of the way [m]; either may be missing.
struct PlanEnds {
  std::optional<mrpt::math::TPoint2D> from;  ///< missing: no way is drawn
  std::optional<mrpt::math::TPoint2D> to;    ///< missing: the frontiers. With it, the transform is the Path Transform
};

/// Runs the Exploration Transform over `map`, towards the frontiers or `ends.to`. Of `config`, whose defaults are those
/// of the explorer: the transform, and how large a frontier is. Throws InputError: no frontier and no `to`; an end is
/// not on free floor, or nearer to obstacles than d_min.
PlanPicture plan_picture(const OccupancyGrid& map, const PlannerConfig& config, const PlanEnds& ends);

}  // namespace rubble::explore
