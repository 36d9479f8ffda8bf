#pragma once

#include "explore/plan/planner.h"
#include "explore/plan/traversable.h"
#include "explore/search/floor_search.h"

namespace rubble::explore {

/// Which of the frontiers in reach is driven to.
enum class FrontierChoice {
  Transform,  ///< the cheapest by eq. (3): close, and by a safe way
  Nearest,    ///< that with the shortest way
  Gain,       ///< that from which most new area is expected to be seen, however far it is
  Value,      ///< that with most new area, and faces to be searched, for each second of the way there
  ByTime      ///< by value where the mission is too short to see all, else by the transform
};

struct FrontierChoiceConfig {
  FrontierChoice by = FrontierChoice::ByTime;
  double face_weight = 0.5;  ///< by value, what a metre of wall face to be searched is worth in new area [m^2/m]

  /// The same without ByTime, for a mission of so many seconds; 0: without a limit.
  FrontierChoiceConfig for_mission(double time_limit) const;
};

/// Empty where the transform chooses, as it does by time where nobody told the mission. The target being driven to has
/// a head start, of `planner.switch_cost` [m] of way where ways count. `speed`: of the robot so far, turns and stops
/// included [m/s]. Refers to `floor` and `search`.
WorthFn frontier_worth(const FrontierChoiceConfig& config, const PlannerConfig& planner, const Traversable& floor,
                       const FloorSearch& search, double speed);

}  // namespace rubble::explore
