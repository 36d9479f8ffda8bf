#include "scenarios/run/run.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include "arenas/files/arena_file.h"
#include "arenas/truth/truth_map.h"
#include "arenas/truth/visible.h"
#include "base/digest.h"
#include "base/error.h"
#include "robot/logs/log.h"
#include "scenarios/run/core.h"
#include "scenarios/run/league_map.h"
#include "scenarios/run/mission_figures.h"
#include "scenarios/run/run_folder.h"
#include "scenarios/run/score_json.h"
#include "scoring/maps/normalise.h"
#include "scoring/measures/victims.h"
#include "scoring/pictures/picture.h"
#include "scoring/scorecard.h"
#include "scoring/trajectory/trajectory_error.h"

namespace rubble::scenarios {
namespace {

using Clock = std::chrono::steady_clock;
using nlohmann::ordered_json;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// The keys users' scripts rely on, in order; null until something is known.
ordered_json empty_score() {
  ordered_json score;
  for (const char* key : {"score", "precision", "recall", "psi_m", "aligned", "ate_first_m", "ate_aligned_m", "known",
                          "victims_found", "victims_total", "sim_s", "wall_s", "real_time_factor", "peak_mb"})
    score[key] = nullptr;
  return score;
}

void add_trajectory_error(ordered_json& json, const Trajectory& estimate, const Trajectory& truth) {
  const scoring::TrajectoryError error = scoring::trajectory_error(estimate, truth);
  json["ate_matched"] = error.matched;
  if (error.matched == 0) return;
  json["ate_first_m"] = error.ate_first_m;
  json["ate_aligned_m"] = error.ate_aligned_m;
}

/// Counts are written without a point.
ordered_json as_json(double value) {
  constexpr double kExact = 9007199254740992.0;  ///< 2^53: whole numbers below are exact
  if (value == std::floor(value) && std::abs(value) < kExact) return static_cast<std::int64_t>(value);
  return value;
}

void add_mapper_counts(ordered_json& json, const Core& core) {
  const slam::MapperCounts& counts = core.mapper().counts();
  json["area_known_m2"] = known_area(core.mapper().map());
  json["scans"] = counts.scans;
  json["scans_mapped"] = counts.mapped;
  for (const slam::MapperFigure& figure : core.mapper().figures()) json[figure.key] = as_json(figure.value);
  json["scans_out_of_order"] = counts.out_of_order;
  json["hits_outside"] = core.mapper().map().dropped_hits();
}

void add_timing(ordered_json& json, double sim_s, Clock::time_point start) {
  const double wall = seconds_since(start);
  json["sim_s"] = sim_s;
  json["wall_s"] = wall;
  json["real_time_factor"] = wall > 0.0 ? sim_s / wall : 0.0;
  json["peak_mb"] = peak_megabytes();
}

std::string without_timing(const ordered_json& score) {
  ordered_json kept;
  for (const auto& [key, value] : score.items())
    if (!is_timing_key(key)) kept[key] = value;
  return kept.dump(2);
}

std::vector<std::string> broken_expectations(const Scenario& scenario, const ordered_json& score) {
  std::vector<std::string> broken;
  for (const auto& e : scenario.expect) {
    const ordered_json value = score.contains(e.key) ? score[e.key] : ordered_json();
    const double number = value.is_boolean()  ? (value.get<bool>() ? 1.0 : 0.0)
                          : value.is_number() ? value.get<double>()
                                              : std::nan("");
    std::ostringstream line;
    line << e.key << " is " << value.dump() << ", expected";
    if (e.min) line << " at least " << *e.min;
    if (e.max) line << (e.min ? " and" : "") << " at most " << *e.max;
    const bool met = number == number && (!e.min || number >= *e.min) && (!e.max || number <= *e.max);
    if (!met) broken.push_back(line.str());
  }
  return broken;
}

/// Where a point of the map frame lies on the league picture that `draw_league_map` made, as it was read back.
mrpt::math::TPoint2D in_picture(const scoring::LoadedMap& picture, const mrpt::math::TPoint2D& p_map,
                                const std::optional<GeoAnchor>& geo) {
  const PixelToModel T_model_start = picture_of_start(geo);
  const double easting = -p_map.y;
  const double southing = -p_map.x;
  return scoring::in_grid(picture, {T_model_start.a * easting + T_model_start.b * southing + T_model_start.c,
                                    T_model_start.d * easting + T_model_start.e * southing + T_model_start.f});
}

/// Scores what was written to disk, as a judge would who gets the two files.
void score_files(ordered_json& json, const RunFolder& folder, const Scenario& scenario, const arenas::Arena& arena,
                 const std::vector<explore::VictimReport>& reported) {
  // The scenario may anchor the map on Earth; a rigid alignment does not care.
  const scoring::LoadedMap picture = scoring::load_map(folder.file("map.tif"));
  const OccupancyGrid& map = picture.grid;
  const OccupancyGrid truth = scoring::load_map(folder.file("truth.tif")).grid;
  const scoring::MapScore score = scoring::score_map(map, truth, scenario.scoring);
  add_map_score(json, score);
  json["victims_total"] = arena.victims.size();
  json["victims_reported"] = reported.size();
  json["victims_found"] = 0;
  if (!score.aligned) return;
  folder.publish({"overlay.png"}, [&](const std::string& path) {
    scoring::write_overlay(path + "overlay.png", map, truth, score.T_truth_map);
  });
  folder.publish({"error.png"}, [&](const std::string& path) {
    scoring::write_error_map(path + "error.png", map, truth, score.T_truth_map, scenario.scoring.tau);
  });
  std::vector<mrpt::math::TPoint2D> p_picture, p_truth;
  for (const auto& victim : reported) p_picture.push_back(in_picture(picture, victim.p_map, scenario.geo));
  for (const auto& victim : arena.victims) p_truth.emplace_back(victim.position.x, victim.position.y);
  const scoring::VictimScore victims = scoring::score_victims(p_picture, p_truth, score.T_truth_map);
  json["victims_found"] = victims.found;
  json["victims_false"] = victims.false_alarms;
  if (victims.found > 0) json["victims_error_m"] = victims.mean_error_m;
}

LoopHooks hooks_of(const RunOptions& options) {
  LoopHooks hooks;
  hooks.interrupted = options.interrupted;
  hooks.progress = options.progress;
  return hooks;
}

std::string folder_for(const RunOptions& options, const Scenario& scenario) {
  return options.out.empty() ? next_run_folder("runs", scenario.name, scenario.seed) : options.out;
}

void finish(RunReport& report, RunFolder& folder, const Scenario& scenario, const RunOptions& options, double sim_s,
            Clock::time_point start) {
  report.score["end"] = report.end;
  const std::string hashed = without_timing(report.score);
  folder.save_hashes(hashed);
  add_timing(report.score, sim_s, start);
  folder.write("score.json", report.score.dump(2) + "\n");
  folder.close();
  const std::filesystem::path parent = std::filesystem::path(folder.path()).parent_path().filename();
  if (options.link_latest && (options.out.empty() || parent == "runs")) folder.link_latest();
  report.folder = folder.path();
  report.broken = broken_expectations(scenario, report.score);
}

}  // namespace

bool is_timing_key(const std::string& key) { return key == "wall_s" || key == "real_time_factor" || key == "peak_mb"; }

namespace {

/// The truth map that the run folder keeps. What this robot can never see is unknown in it.
OccupancyGrid truth_to_score_with(const arenas::Arena& arena, const Scenario& scenario) {
  const OccupancyGrid truth = arenas::truth_map(arena);
  if (!scenario.visible_truth) return truth;
  constexpr double kAboveLaser = 0.05;  ///< the body ends so much above the laser [m]
  arenas::Viewer viewer;
  viewer.radius = 0.5 * scenario.robot.width;
  viewer.height = scenario.robot.T_base_laser.z + kAboveLaser;
  viewer.climbable_step = scenario.robot.climbable_step;
  viewer.range = scenario.robot.laser.range_max;
  return arenas::visible_truth(arena, truth, viewer);
}

}  // namespace

RunReport run_scenario(const Scenario& scenario, const RunOptions& options) {
  const auto start = Clock::now();
  const std::string yaml = arena_yaml(scenario);
  const arenas::Arena arena =
      arenas::parse_arena(yaml, scenario.arena_file.empty() ? "generated arena" : scenario.arena_file);
  arenas::check(arena, scenario.arena_file.empty() ? "generated arena" : scenario.arena_file);

  RunFolder folder(folder_for(options, scenario), options.replace);
  Scenario resolved = scenario;
  resolved.arena_file = "arena.yaml";
  folder.write("arena.yaml", yaml);
  folder.write("scenario.yaml", resolved_yaml(resolved));
  folder.write("versions.json", versions().dump(2) + "\n");
  folder.save_truth(arena, truth_to_score_with(arena, scenario));

  sim::SimRobot simulated(arena, scenario.robot, scenario.sim, scenario.seed);
  Core core(scenario, scenario.robot, true);
  RunReport report;
  report.score = empty_score();
  LoopHooks hooks = hooks_of(options);
  hooks.share = [&] {
    return simulated.truth().empty() ? 0.0 : simulated.truth().back().stamp.seconds() / scenario.time_limit;
  };
  hooks.each_second = [&] { folder.append_truth(simulated.truth()); };
  LoopEnd end;
  {
    std::optional<robot::RecordingRobot> recorded;
    if (options.record) recorded.emplace(simulated, folder.file("log.rlog"), resolved_yaml(resolved));
    end = Loop(scenario, folder, hooks).run(recorded ? static_cast<robot::Robot&>(*recorded) : simulated, core);
    if (recorded) recorded->flush();
  }
  add_trajectory_error(report.score, core.mapper().trajectory(), simulated.truth());
  score_files(report.score, folder, scenario, arena, core.victims());
  add_mission_figures(report.score, arena, simulated.truth(), scenario.robot, core);
  folder.write("decisions.txt", decisions_text(core));
  add_mapper_counts(report.score, core);
  report.end = end.reason;
  report.interrupted = end.interrupted;
  report.failure = end.failure;
  finish(report, folder, scenario, options, end.sim_s, start);
  return report;
}

RunReport map_log(const std::string& log, const Scenario& scenario, const RunOptions& options) {
  const auto start = Clock::now();
  robot::ReplayRobot robot(log);
  Scenario resolved = scenario;
  if (resolved.name == "map") resolved.name = "map-" + std::filesystem::path(log).stem().stem().string();
  RunFolder folder(folder_for(options, resolved), options.replace);
  folder.write("scenario.yaml", "# rubble map " + log + " (" + robot.format() + ")\n" + resolved_yaml(resolved));
  folder.write("versions.json", versions().dump(2) + "\n");
  Core core(resolved, robot.model(), false);
  RunReport report;
  report.score = empty_score();
  if (!robot.reference().empty()) folder.append_truth(robot.reference());
  LoopHooks hooks = hooks_of(options);
  hooks.share = [&] { return robot.progress(); };
  const LoopEnd end = Loop(resolved, folder, hooks).run(robot, core);
  if (core.mapper().counts().scans == 0 && !end.interrupted)
    throw InputError(log + ": holds no laser scan; a log to map needs scans (and odometry)");
  if (!robot.reference().empty()) add_trajectory_error(report.score, core.mapper().trajectory(), robot.reference());
  add_mapper_counts(report.score, core);
  report.end = end.interrupted    ? end.reason
               : robot.was_torn() ? "the log is cut: its torn last frame was dropped"
                                  : "the log is over";
  report.interrupted = end.interrupted;
  finish(report, folder, resolved, options, end.sim_s, start);
  return report;
}

}  // namespace rubble::scenarios
