#include "explore/paper/frontier_worth.h"

#include "explore/plan/outlook.h"

namespace rubble::explore {
namespace {

constexpr double kStay = 1.25;     ///< so many times the area of another the one being driven to counts
constexpr double kShort = 240.0;   ///< in a mission shorter than this not all of an arena can be seen [s]
constexpr double kTurnTime = 2.0;  ///< a target costs beside its way [s]

}  // namespace

FrontierChoiceConfig FrontierChoiceConfig::for_mission(double time_limit) const {
  FrontierChoiceConfig resolved = *this;
  const bool is_short = time_limit > 0.0 && time_limit < kShort;
  if (by == FrontierChoice::ByTime) resolved.by = is_short ? FrontierChoice::Value : FrontierChoice::Transform;
  return resolved;
}

WorthFn frontier_worth(const FrontierChoiceConfig& config, const PlannerConfig& planner, const Traversable& floor,
                       const FloorSearch& search, double speed) {
  const auto way = [switch_cost = planner.switch_cost](const Candidate& c) {
    return c.way + (c.driven_to ? 0.0 : switch_cost);
  };
  switch (config.by) {
    case FrontierChoice::Transform:
    case FrontierChoice::ByTime:
      break;
    case FrontierChoice::Nearest:
      return [way](const Candidate& c) { return -way(c); };
    case FrontierChoice::Gain:
      return [&floor](const Candidate& c) { return expected_area(floor, c.middle) * (c.driven_to ? kStay : 1.0); };
    case FrontierChoice::Value:
      return [way, &floor, &search, speed, weight = config.face_weight](const Candidate& c) {
        const double faces = weight > 0.0 ? weight * search.faces_in_view(floor, c.middle) : 0.0;
        return (expected_area(floor, c.middle) + faces) / (way(c) / speed + kTurnTime);
      };
  }
  return {};
}

}  // namespace rubble::explore
