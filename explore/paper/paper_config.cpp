#include "explore/paper/paper_config.h"

#include <cmath>
#include <initializer_list>
#include <utility>

#include "base/text/number_text.h"

namespace rubble::explore {

void bind(Binder& b, PaperExplorerConfig& c) {
  TransformConfig& transform = c.planner.transform;
  b.number("alpha", transform.alpha, 0.0, 1000.0);
  b.number("d_min_m", transform.d_min, 0.0, 2.0);
  b.number("d_opt_m", transform.d_opt, 0.0, 5.0);
  b.choice("discomfort", transform.discomfort, {"per_metre", "per_cell"});
  b.boolean("bar_targets", c.bar_targets);
  b.choice("choice", c.choice.by, {"transform", "nearest", "gain", "value", "by_time"});
  b.number("face_weight", c.choice.face_weight, 0.0, 100.0);
  b.section("priorities", [&](Binder& p) {
    p.number("niches_m", c.priorities.niches, 0.0, 1000.0);
    p.number("faces_m", c.priorities.faces, 0.0, 1000.0);
    p.number("frontiers_m", c.priorities.frontiers, 0.0, 1000.0);
  });
  b.number("occupied_threshold", c.occupied_threshold, 0.01, 1.0);
  b.integer("min_frontier_cells", c.planner.min_frontier_cells, 1, 10000);
  b.number("replan_period_s", c.replan_period, 0.02, 60.0);
  b.number("cruise_speed", c.follower.cruise_speed, 0.01, 2.0);
  b.number("passed_speed", c.follower.passed_speed, 0.01, 2.0);
  b.number("rough_speed", c.follower.rough_speed, 0.01, 2.0);
  b.number("slope_speed", c.follower.slope_speed, 0.01, 2.0);
  b.degrees("turn_speed_deg", c.follower.turn_speed, 1.0, 360.0);
  b.degrees("slope_turn_deg", c.follower.slope_turn, 1.0, 360.0);
  b.degrees("turn_in_place_deg", c.follower.turn_in_place, 1.0, 180.0);
  b.number("look_ahead_m", c.follower.look_ahead, 0.05, 5.0);
  b.boolean("return_home", c.return_home);
  b.number("d_min_floor_m", c.planner.d_min_floor, 0.0, 2.0);
  b.number("switch_cost_m", c.planner.switch_cost, 0.0, 100.0);
  b.number("felt_memory_s", c.felt.memory, 0.0, 1e6);
  b.number("pallet_m", c.felt.pallet, 0.0, 10.0);
  b.degrees("too_steep_deg", c.tilt.too_steep, 1.0, 90.0);
  b.section("victims", [&](Binder& v) {
    v.integer("min_cues", c.victims.min_cues, 1, 1000);
    v.number("min_evidence", c.victims.min_evidence, 0.0, 1000.0);
    v.number("merge_distance_m", c.victims.merge_distance, 0.0, 10.0);
    v.number("memory_s", c.victims.memory, 0.0, 1e6);
    v.boolean("search", c.search.on);
    v.boolean("faces", c.search.faces);
    v.degrees("field_of_view_deg", c.search.field_of_view, 5.0, 360.0);
    v.number("range_m", c.search.range, 0.3, 20.0);
    v.integer("min_cells", c.search.min_cells, 1, 100000);
    v.choice("squarely", c.search.squarely, {"never", "holes", "always"});
    v.choice("other_senses", c.search.other_senses, {"suspects", "everywhere"});
    v.boolean("low_walls", c.search.low_walls);
    v.number("stare_s", c.search.stare, 0.0, 60.0);
    v.integer("stares", c.search.stares, 1, 100);
    v.number("dwell_s", c.search.dwell, 0.0, 60.0);
  });
}

std::string mistake(const PaperExplorerConfig& config) {
  const TransformConfig& transform = config.planner.transform;
  if (transform.d_opt < transform.d_min)
    return "d_opt_m, " + number_text(transform.d_opt) + ", must not be smaller than d_min_m, " +
           number_text(transform.d_min);
  // The default of one does not make a mistake of the other.
  const double floor = config.planner.d_min_floor;
  if (floor > transform.d_min && floor != PlannerConfig().d_min_floor)
    return "d_min_floor_m, " + number_text(floor) + ", must not be larger than d_min_m, " +
           number_text(transform.d_min) + ", which falls to it";
  return "";
}

std::vector<std::string> notes(const PaperExplorerConfig& config, const robot::RobotModel& model,
                               const Mission& mission) {
  std::vector<std::string> notes;
  const FollowerConfig usual;
  const auto add_fast = [&](const char* limit_key, double limit, double unit,
                            std::initializer_list<std::pair<const char*, double FollowerConfig::*>> speeds) {
    const auto in_unit = [&](double value) { return number_text(std::round(1e6 * value / unit) / 1e6); };
    std::string fast;
    for (const auto& [key, speed] : speeds)
      if (config.follower.*speed > limit + 1e-9 && config.follower.*speed != usual.*speed)
        fast += (fast.empty() ? "explorer." : ", ") + std::string(key) + "=" + in_unit(config.follower.*speed);
    if (!fast.empty()) notes.push_back(fast + ": the robot drives no faster than " + limit_key + "=" + in_unit(limit));
  };
  add_fast("robot.max_v", model.max_v, 1.0,
           {{"cruise_speed", &FollowerConfig::cruise_speed},
            {"passed_speed", &FollowerConfig::passed_speed},
            {"rough_speed", &FollowerConfig::rough_speed},
            {"slope_speed", &FollowerConfig::slope_speed}});
  add_fast("robot.max_w_deg", model.max_w, deg_to_rad(1.0),
           {{"turn_speed_deg", &FollowerConfig::turn_speed}, {"slope_turn_deg", &FollowerConfig::slope_turn}});
  if (config.search.other_senses == OtherSearch::Everywhere && !mission.senses.microphones && !mission.senses.co2_probe)
    notes.push_back(
        "explorer.victims.other_senses=everywhere: the robot has neither microphones nor a CO2 probe to search with, "
        "so it searches by its cameras alone");
  return notes;
}

}  // namespace rubble::explore
