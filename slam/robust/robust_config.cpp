#include <algorithm>

#include "slam/robust/robust_mapper.h"

namespace rubble::slam {

namespace {

constexpr double kFarSight = 8.0;    ///< from this reach a scanner sees surfaces from afar, thinly [m]
constexpr double kLeastCell = 0.02;  ///< of surfels [m]: the memory of their grid grows with its square

/// 0, which leaves the choice to the reach, or a number within bounds.
void chosen_or_number(Binder& b, const char* key, double& value, double low, double high) {
  b.number(key, value, 0.0, high);
  if (!b.writes() && value > 0.0 && value < low) b.number(key, value, low, high);
}

}  // namespace

RobustConfig suited_to(const robot::LaserModel& laser, RobustConfig config) {
  const double reach = config.scan.max_range > 0.0 ? std::min(config.scan.max_range, laser.range_max) : laser.range_max;
  const bool far = reach > kFarSight;
  const auto choose = [far](double& value, double near_by, double from_afar) {
    if (value == 0.0) value = far ? from_afar : near_by;
  };
  choose(config.tracker.cell, 0.10, 0.15);
  choose(config.tracker.path, 4.0, 10.0);
  choose(config.tracker.search_blur, 0.06, 0.10);
  choose(config.loop.blur, 0.06, 0.10);
  return config;
}

LevelScanConfig stamping(const RobustConfig& config) {
  LevelScanConfig scan = config.scan;
  scan.carve_misses = config.misses != MissTrust::None;
  return scan;
}

void bind(Binder& b, RobustConfig& c) {
  b.integer("map_cells", c.map_cells, 16, 8000);
  b.number("resolution_m", c.resolution, 0.01, 0.5);
  b.integer("max_map_cells", c.max_map_cells, 16, 20000);
  b.number("max_range_m", c.scan.max_range, 0.0, 1000.0);
  bind_misses(b, c.misses);
  b.number("floor_margin_m", c.scan.floor_margin, 0.0, 1.0);
  b.number("ramp_margin_m", c.scan.ramp_margin, 0.0, 1.0);
  b.boolean("deskew", c.deskew);
  b.boolean("use_tilt", c.use_tilt);
  b.number("map_distance_m", c.map_distance, 0.0, 2.0);
  b.degrees("map_turn_deg", c.map_turn, 0.0, 180.0);
  b.integer("first_scans", c.first_scans, 1, 1000);
  b.number("frame_distance_m", c.frame_distance, 0.02, 2.0);
  b.number("frame_turn_rad", c.frame_turn, 0.02, 3.0);
  b.number("frame_overlap", c.frame_overlap, 0.0, 1.0);
  b.integer("exact_frames", c.exact_frames, 10, 1000000);
  b.boolean("drop_gone", c.drop_gone);
  b.boolean("thin_walls", c.thin_walls);
  b.boolean("loops", c.loops);
  b.boolean("wall_compass", c.wall_compass);
  b.number("budget_ms", c.budget_ms, 0.1, 1e6);
  b.section("matching", [&](Binder& m) {
    m.number("spacing_m", c.cloud.spacing, 0.01, 1.0);
    m.number("loose_within_m", c.cloud.loose_within, 0.0, 100.0);
    chosen_or_number(m, "cell_m", c.tracker.cell, kLeastCell, 1.0);
    m.integer("frames", c.tracker.frames, 1, 1000);
    m.number("path_m", c.tracker.path, 0.0, 1000.0);
    m.number("distance_error", c.tracker.distance_error, 0.0, 10.0);
    m.number("least_distance_m", c.tracker.least_distance, 0.001, 1.0);
    m.number("turn_error", c.tracker.turn_error, 0.0, 10.0);
    m.number("least_turn_rad", c.tracker.least_turn, 0.001, 1.0);
    m.number("turn_error_rad_per_m", c.tracker.turn_error_per_m, 0.0, 10.0);
    m.number("wheel_friction", c.tracker.wheel_friction, 0.0, 10.0);
    m.number("vain_error", c.tracker.vain_error, 0.0, 10.0);
    m.number("creep_error", c.tracker.creep_error, 0.0, 10.0);
    m.number("large_step_m", c.tracker.large_step, 0.05, 100.0);
    m.number("large_turn_rad", c.tracker.large_turn, 0.05, 10.0);
    m.number("slip_chi2", c.tracker.slip_chi2, 1.0, 1e9);
    m.boolean("hold_leaps", c.tracker.hold_leaps);
    m.number("lost_inliers", c.tracker.lost_inliers, 0.0, 1.0);
    m.number("search_cell_m", c.tracker.search_cell, 0.01, 0.5);
    m.number("search_blur_m", c.tracker.search_blur, 0.0, 1.0);
  });
  b.section("loop_search", [&](Binder& l) {
    l.number("least_path_m", c.loop.least_path, 1.0, 1000.0);
    l.number("window_m", c.loop.window, 0.05, 10.0);
    l.number("window_per_m", c.loop.window_per_m, 0.0, 1.0);
    l.number("largest_window_m", c.loop.largest_window, 0.1, 20.0);
    l.integer("searches", c.loop.searches, 0, 100);
    l.number("cell_m", c.loop.cell, 0.01, 0.5);
    l.number("blur_m", c.loop.blur, 0.0, 1.0);
    l.number("least_score", c.loop.least_score, 0.0, 1.0);
    l.number("runner_up", c.loop.runner_up, 0.0, 1.0);
    l.number("least_inliers", c.loop.least_inliers, 0.0, 1.0);
    l.number("most_contradiction", c.loop.most_contradiction, 0.0, 1.0);
    l.number("expected_contradiction", c.loop.expected_contradiction, 0.0, 1.0);
    l.integer("confirmations", c.loop.confirmations, 1, 100);
    l.number("sure_contradiction", c.loop.sure_contradiction, 0.0, 1.0);
    l.number("apart_m", c.loop.apart_distance, 0.0, 100.0);
    l.integer("views", c.loop.views, 1, 100);
    l.number("astray_contradiction", c.loop.astray_contradiction, 0.0, 2.0);
    l.number("astray_window_m", c.loop.astray_window, 0.05, 10.0);
    l.number("astray_angle_rad", c.loop.astray_angle, 0.0, kPi);
    l.number("scaling", c.loop.scaling, 0.1, 1e6);
  });
}

}  // namespace rubble::slam
