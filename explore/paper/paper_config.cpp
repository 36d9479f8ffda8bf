#include "explore/paper/paper_config.h"

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
  return "";
}

}  // namespace rubble::explore
