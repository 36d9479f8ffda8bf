#include "explore/paper/frontier_worth.h"

#include "explore/plan/outlook.h"

namespace rubble::explore {
namespace {

constexpr double kStay = 1.25;     ///< so many times the area of another the one being driven to counts
constexpr double kTurnTime = 2.0;  ///< a target costs beside its way [s]

}  // namespace

WorthFn frontier_worth(const FrontierChoiceConfig& config, const PlannerConfig& planner, const Traversable& floor,
                       const FloorSearch& search, double speed) {
  const auto way = [switch_cost = planner.switch_cost](const Candidate& c) {
    return c.way + (c.driven_to ? 0.0 : switch_cost);
  };
  switch (config.by) {
    case FrontierChoice::Transform:
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
