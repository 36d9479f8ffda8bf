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
#include "base/text/file_name.h"
#include "base/text/words.h"
#include "robot/logs/log.h"
#include "scenarios/run/core.h"
#include "scenarios/run/league_map.h"
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

double known_area(const slam::CountMap& map) {
  std::size_t cells = 0;
  for (int y = 0; y < map.frame().height; ++y)
    for (int x = 0; x < map.frame().width; ++x) cells += map.seen({x, y}) > 0 ? 1u : 0u;
  return static_cast<double>(cells) * map.frame().resolution * map.frame().resolution;
}

/// How a loop ended.
struct LoopEnd {
  std::string reason;
  std::string failure;
  bool interrupted = false;
  double sim_s = 0.0;
};

/// The one loop, for simulator, log and hardware alike. Saves the trajectories every second of run time and the map
/// after the first of these, then ever more seldom up to every few seconds of wall time.
class Loop {
 public:
  Loop(const Scenario& scenario, const RunOptions& options, RunFolder& folder)
      : scenario_(scenario), options_(options), folder_(folder) {}

  /// `share` tells how far the robot is (0..1); `each_second` lets the caller append what only it knows.
  LoopEnd run(robot::Robot& robot, Core& core, const std::function<double()>& share,
              const std::function<void()>& each_second) {
    LoopEnd end{"the robot's time is over", "", false, 0.0};
    Stamp first = Stamp::never(), saved = Stamp::never();
    try {
      while (auto inputs = robot.read()) {
        robot.command(core.step(*inputs));
        if (first == Stamp::never()) first = saved = inputs->now;
        end.sim_s = inputs->now - first + robot.model().tick;
        if (inputs->now - saved >= 1.0) {
          saved = inputs->now;
          folder_.append_estimate(core.mapper().trajectory());
          each_second();
          report(core, end.sim_s, share());
        }
        if (core.finished()) {
          end.reason = core.reason();
          break;
        }
        if (options_.interrupted && options_.interrupted()) {
          end.interrupted = true;
          end.reason = "interrupted";
          break;
        }
      }
    } catch (const robot::DeviceLost& lost) {
      end.failure = end.reason = lost.what();
    }
    folder_.append_estimate(core.mapper().trajectory());
    each_second();
    return end;
  }

 private:
  void report(const Core& core, double sim_s, double share) {
    if (seconds_since(last_save_) >= save_period_) {
      folder_.save_map(scenario_, core.mapper(), core.victims());
      last_save_ = Clock::now();
      save_period_ = std::min(kLongestSavePeriod, 2.0 * save_period_ + kFirstSavePeriod);
    }
    if (options_.progress && seconds_since(last_report_) > 0.2) {
      last_report_ = Clock::now();
      options_.progress({sim_s, share, known_area(core.mapper().map()), sim_s / seconds_since(start_)});
    }
  }

  const Scenario& scenario_;
  const RunOptions& options_;
  RunFolder& folder_;
  Clock::time_point start_ = Clock::now();
  static constexpr double kFirstSavePeriod = 0.4;    ///< [s]
  static constexpr double kLongestSavePeriod = 3.0;  ///< [s]
  double save_period_ = 0.0;  ///< grows: a run of a few seconds leaves a map too when it is killed [s]
  Clock::time_point last_save_ = start_;
  Clock::time_point last_report_ = start_;
};

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
  LoopEnd end;
  {
    std::optional<robot::RecordingRobot> recorded;
    if (options.record) recorded.emplace(simulated, folder.file("log.rlog"), resolved_yaml(resolved));
    Loop loop(scenario, options, folder);
    end = loop.run(
        recorded ? static_cast<robot::Robot&>(*recorded) : simulated, core,
        [&] {
          return simulated.truth().empty() ? 0.0 : simulated.truth().back().stamp.seconds() / scenario.time_limit;
        },
        [&] { folder.append_truth(simulated.truth()); });
    if (recorded) recorded->flush();
  }
  folder.save_map(scenario, core.mapper(), core.victims());
  add_trajectory_error(report.score, core.mapper().trajectory(), simulated.truth());
  score_files(report.score, folder, scenario, arena, core.victims());
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
  if (resolved.name == "map") resolved.name = as_file_name("map-" + std::filesystem::path(log).stem().stem().string());
  RunFolder folder(folder_for(options, resolved), options.replace);
  folder.write("scenario.yaml",
               "# rubble map " + one_line(log) + " (" + robot.format() + ")\n" + resolved_yaml(resolved));
  folder.write("versions.json", versions().dump(2) + "\n");
  Core core(resolved, robot.model(), false);
  RunReport report;
  report.score = empty_score();
  Loop loop(resolved, options, folder);
  if (!robot.reference().empty()) folder.append_truth(robot.reference());
  const LoopEnd end = loop.run(
      robot, core, [&] { return robot.progress(); }, [] {});
  if (core.mapper().counts().scans == 0 && !end.interrupted)
    throw InputError(log + ": holds no laser scan; a log to map needs scans (and odometry)");
  folder.save_map(resolved, core.mapper(), {});
  if (!robot.reference().empty()) add_trajectory_error(report.score, core.mapper().trajectory(), robot.reference());
  add_mapper_counts(report.score, core);
  report.end = end.interrupted    ? end.reason
               : robot.was_torn() ? "the log is cut: its torn last frame was dropped"
                                  : "the log is over";
  report.interrupted = end.interrupted;
  finish(report, folder, resolved, options, end.sim_s, start);
  return report;
}

namespace {

std::string scratch_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "rubble-replay-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw RunError(name + ": cannot be created; make the temporary folder writable or give --out");
  return name;
}

/// Whether the bytes of `beginning` are the first ones of `whole`.
bool starts_with_file(const std::string& whole, const std::string& beginning) {
  std::ifstream a(whole, std::ios::binary);
  std::ifstream b(beginning, std::ios::binary);
  const std::string first{std::istreambuf_iterator<char>(b), {}};
  std::string same(first.size(), '\0');
  a.read(same.data(), static_cast<std::streamsize>(same.size()));
  return a.gcount() == static_cast<std::streamsize>(first.size()) && same == first;
}

}  // namespace

ReplayReport replay_run(const std::string& path, const RunOptions& options) {
  namespace fs = std::filesystem;
  const std::string log = path + "/log.rlog";
  if (!fs::exists(log))
    throw InputError(path + ": is not a recorded run (no log.rlog in it); give a folder that 'rubble run' wrote");
  const Scenario scenario = load_scenario(path + "/scenario.yaml");
  robot::ReplayRobot robot(log);
  Core core(scenario, robot.model(), true);
  ReplayReport report;
  report.ended = fs::exists(path + "/hashes.json");
  bool last_differs = false;
  while (auto inputs = robot.read()) {
    const robot::Commands commands = core.step(*inputs);
    const robot::Commands& recorded = robot.recorded_commands();
    ++report.ticks;
    last_differs = commands.drive.v != recorded.drive.v || commands.drive.w != recorded.drive.w ||
                   commands.aim.pitch != recorded.aim.pitch || commands.aim.roll != recorded.aim.roll;
    if (last_differs) ++report.different_commands;
    if (core.finished()) break;
    if (options.interrupted && options.interrupted()) break;
  }
  const std::string scratch = options.out.empty() ? scratch_folder() : std::string();
  RunFolder folder(options.out.empty() ? scratch : options.out, options.replace);
  folder.write("scenario.yaml", resolved_yaml(scenario));
  folder.append_estimate(core.mapper().trajectory());
  folder.save_map(scenario, core.mapper(), core.victims());
  // A run that was killed wrote its trajectory up to its last second, an older map, and its last tick perhaps without
  // the command that answered it.
  if (!report.ended && last_differs) --report.different_commands;
  report.identical = report.different_commands == 0;
  const auto compare = [&](const std::string& name) {
    const std::string then = path + "/" + name;
    if (!fs::exists(then)) return false;
    if (report.ended) return sha256_of_file(then) == sha256_of_file(folder.file(name));
    return starts_with_file(folder.file(name), then);
  };
  for (const char* name : {"estimate.tum", "map.tif", "map.tfw", "map.png", "map.pgm", "map.yaml", "pois.csv"}) {
    if (!report.ended && std::string(name) != "estimate.tum") continue;
    report.artefacts.push_back({name, compare(name)});
    report.identical = report.identical && report.artefacts.back().same;
  }
  folder.close();
  if (options.out.empty()) fs::remove_all(scratch);
  return report;
}

}  // namespace rubble::scenarios
