#include "scenarios/run/run.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "arenas/files/arena_file.h"
#include "arenas/model/patch_index.h"
#include "arenas/truth/truth_map.h"
#include "arenas/truth/visible.h"
#include "base/angle.h"
#include "base/digest.h"
#include "base/error.h"
#include "base/text/file_name.h"
#include "base/text/words.h"
#include "explore/victim_report.h"
#include "robot/logs/log.h"
#include "scenarios/config/viewer.h"
#include "scenarios/run/core.h"
#include "scenarios/run/loop.h"
#include "scenarios/run/map_files.h"
#include "scenarios/run/mission_figures.h"
#include "scenarios/run/run_folder.h"
#include "scenarios/run/score_json.h"
#include "scoring/league/league_victims.h"
#include "scoring/maps/normalise.h"
#include "scoring/marks.h"
#include "scoring/pictures/picture.h"
#include "scoring/pictures/sight_picture.h"
#include "scoring/scorecard.h"
#include "scoring/trajectory/relative_error.h"
#include "scoring/trajectory/trajectory_error.h"

namespace rubble::scenarios {
namespace {

using Clock = std::chrono::steady_clock;
using nlohmann::ordered_json;

/// Trajectories of the mapper against the true one.
void compare_trajectories(scoring::Evidence& evidence, const slam::Mapper& mapper, const Trajectory& truth) {
  evidence.estimate = &mapper.trajectory();
  evidence.live_estimate = &mapper.live_trajectory();
  evidence.true_path = &truth;
  evidence.error = scoring::trajectory_error(*evidence.estimate, truth);
  evidence.live_error = scoring::trajectory_error(*evidence.live_estimate, truth);
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
  const PixelToModel T_model_start = scoring::picture_of_start(geo);
  const double easting = -p_map.y;
  const double southing = -p_map.x;
  return scoring::in_grid(picture, {T_model_start.a * easting + T_model_start.b * southing + T_model_start.c,
                                    T_model_start.d * easting + T_model_start.e * southing + T_model_start.f});
}

/// What was written to disk, as a judge gets it.
struct WrittenMaps {
  scoring::LoadedMap map;
  scoring::LoadedMap truth;
};

/// The pose of the written map on the truth if it were right about where the robot started.
scoring::KnownStart known_start(const scoring::LoadedMap& picture, const std::optional<GeoAnchor>& geo,
                                const mrpt::math::TPose2D& T_truth_start) {
  const mrpt::math::TPoint2D start = in_picture(picture, {0.0, 0.0}, geo);
  const mrpt::math::TPoint2D ahead = in_picture(picture, {1.0, 0.0}, geo);
  const mrpt::math::TPose2D T_picture_start(start.x, start.y, std::atan2(ahead.y - start.y, ahead.x - start.x));
  return {T_truth_start + (mrpt::math::TPose2D() - T_picture_start), start};
}

/// The victims that were reported, on the picture, and those there are.
struct VictimLists {
  scoring::ReportedVictims reported;
  scoring::TrueVictims there_are;
};

/// The run's own list counts from where the robot started.
VictimLists victim_lists(const WrittenMaps& files, const Scenario& scenario, const arenas::Arena& arena,
                         const std::vector<explore::VictimReport>& victims) {
  VictimLists out;
  out.reported.from = scoring::VictimSource::List;
  out.reported.symbols = files.map.symbols.size();
  for (const auto& victim : victims)
    out.reported.victims.push_back(
        {explore::victim_name(victim.id), in_picture(files.map, victim.p_map, scenario.geo)});
  out.there_are.path = "arena.yaml";
  for (const auto& victim : arena.victims)
    out.there_are.victims.push_back({victim.name, {victim.position.x, victim.position.y}});
  return out;
}

WrittenMaps read_written(const RunFolder& folder) {
  return {scoring::load_map(folder.file("map.tif")), scoring::load_map(folder.file("truth.tif"))};
}

/// Scores them. The scenario may anchor the map on Earth; a rigid alignment does not care.
void score_files(scoring::Evidence& evidence, const WrittenMaps& files, const VictimLists& victims,
                 const RunFolder& folder, const Scenario& scenario, const mrpt::math::TPose2D& T_truth_start) {
  evidence.map_read_as = files.map.recognised;
  evidence.truth_read_as = files.truth.recognised;
  const OccupancyGrid& map = files.map.grid;
  const OccupancyGrid& truth = files.truth.grid;
  scoring::ScoreConfig config = scenario.scoring;
  config.alignment.start = known_start(files.map, scenario.geo, T_truth_start);
  const scoring::MapScore score = scoring::score_map(map, truth, config);
  evidence.score = score;
  evidence.victims = scoring::victim_figures(
      victims.reported, scoring::victim_points(map, truth, score, victims.reported, victims.there_are));
  if (!score.aligned && score.by == scoring::AlignBy::Auto) return;
  folder.publish({"overlay.png"}, [&](const std::string& path) {
    scoring::write_overlay(path + "overlay.png", map, truth, score.T_truth_map,
                           score.aligned ? "" : "NOT TRUSTED: " + score.note,
                           scoring::marks_on_overlay(score, victims.reported.victims, victims.there_are.victims, true));
  });
  if (!score.aligned) return;
  folder.publish({"error.png"}, [&](const std::string& path) {
    scoring::write_error_map(path + "error.png", map, truth, score.T_truth_map, scenario.scoring.tau);
  });
  folder.publish({"sight.png"}, [&](const std::string& path) {
    scoring::write_sight_map(path + "sight.png", map, truth, score.T_truth_map);
  });
}

LoopHooks hooks_of(const RunOptions& options) {
  LoopHooks hooks;
  hooks.interrupted = options.interrupted;
  hooks.progress = options.progress;
  hooks.decided = options.decided;
  hooks.waits = options.waits;
  return hooks;
}

std::string folder_for(const RunOptions& options, const Scenario& scenario) {
  return options.out.empty() ? next_run_folder("runs", scenario.name, scenario.seed) : options.out;
}

void finish(RunReport& report, scoring::Evidence& evidence, RunFolder& folder, const Scenario& scenario,
            Clock::time_point start) {
  report.end = evidence.run->end;
  evidence.machine = scoring::MachineFigures{seconds_since(start), peak_megabytes()};
  *report.score = score_json(evidence);
  // Beside the figures: people read them, nothing compares them.
  if (!report.unseen_victims.empty()) (*report.score)["unseen_victims"] = report.unseen_victims;
  folder.save_hashes(without_machine(*report.score).dump(2));
  folder.write("score.json", report.score->dump(2) + "\n");
  folder.close(!report.interrupted && report.failure.empty());
  report.folder = folder.path();
  report.broken = broken_expectations(scenario, *report.score);
}

}  // namespace

namespace {

/// The truth map that the run folder keeps. What this robot can never see is unknown in it.
OccupancyGrid truth_to_score_with(const arenas::Arena& arena, const Scenario& scenario) {
  const OccupancyGrid truth = arenas::truth_map(arena);
  if (!scenario.visible_truth) return truth;
  return arenas::visible_truth(arena, truth, viewer_of(scenario.robot));
}

}  // namespace

RunReport run_scenario(const Scenario& scenario, const RunOptions& options) {
  const auto start = Clock::now();
  scenario.mapper.require_permission();
  const std::string yaml = arena_yaml(scenario);
  const arenas::Arena arena =
      arenas::parse_arena(yaml, scenario.arena_file.empty() ? "generated arena" : scenario.arena_file);
  arenas::check(arena, scenario.arena_file.empty() ? "generated arena" : scenario.arena_file);

  RunFolder folder(folder_for(options, scenario), options.replace);
  Scenario resolved = scenario;
  resolved.arena_file = "arena.yaml";
  folder.write("arena.yaml", yaml);
  folder.write("scenario.yaml", resolved_yaml(resolved));
  folder.write("versions.json", versions().json(2) + "\n");
  const OccupancyGrid truth = truth_to_score_with(arena, scenario);
  folder.save_truth(arena, truth);

  sim::SimRobot simulated(arena, scenario.robot, scenario.sim, scenario.seed);
  Core core(scenario, scenario.robot, true, folder.path());
  LoopHooks hooks = hooks_of(options);
  hooks.share = [&] {
    return simulated.truth().empty() ? 0.0 : simulated.truth().back().stamp.seconds() / scenario.time_limit;
  };
  const arenas::PatchIndex floor(arena);
  hooks.over = [&]() -> std::string {
    if (simulated.truth().empty()) return "";
    return off_the_floor(floor, simulated.truth().back().pose) ? "the robot drove off the floor" : "";
  };
  hooks.each_second = [&](double) { folder.append_truth(simulated.truth()); };
  LoopEnd end;
  {
    std::optional<robot::RecordingRobot> recorded;
    if (options.record) recorded.emplace(simulated, folder.file("log.rlog"), resolved_yaml(resolved));
    end = Loop(scenario, folder, core, hooks).run(recorded ? static_cast<robot::Robot&>(*recorded) : simulated);
    if (recorded) recorded->flush();
  }
  scoring::Evidence evidence;
  compare_trajectories(evidence, core.mapper(), simulated.truth());
  const WrittenMaps files = read_written(folder);
  score_files(evidence, files, victim_lists(files, scenario, arena, core.victims()), folder, scenario, arena.start);
  evidence.map = &files.map.grid;
  evidence.truth = &files.truth.grid;
  evidence.run = run_figures(core, end.sim_s, end.reason);
  evidence.mission =
      mission_figures(arena, simulated.truth(), scenario.robot, core, scenario.visible_truth ? &truth : nullptr);
  std::string decisions = decisions_text(core);
  if (end.interrupted && evidence.mission->end_code == "time") {
    evidence.mission->end_code = "interrupted";
    if (!simulated.truth().empty()) decisions += decision_line({simulated.truth().back().stamp, "ends: interrupted"});
  }
  folder.write("decisions.txt", decisions);
  if (options.record) save_map_files(folder, core.mapper());
  RunReport report;
  report.interrupted = end.interrupted;
  report.failure = end.failure;
  for (const std::string& name : evidence.mission->unseen_victims)
    report.unseen_victims.push_back(scoring::true_victim_name(name));
  finish(report, evidence, folder, scenario, start);
  if (options.link_latest) folder.link_latest(core.mapper());
  return report;
}

namespace {

/// As it stood on the command line.
std::string base_as_typed(const RunOptions& options) {
  if (!options.base) return "";
  return (options.base->grows ? " --continue " : " --localise ") + one_line(options.base->name);
}

/// Of a mapper on the map of an earlier run.
bool knows_no_place(const slam::Mapper& mapper) {
  const auto figures = mapper.figures();
  return std::any_of(figures.begin(), figures.end(), [](const slam::MapperFigure& f) {
    return f.key == slam::MapperFigure::kPlaceKnown && f.value == 0.0;
  });
}

/// Of the scans, those whose place was known at once, in whole per cent.
int share_placed(const slam::Mapper& mapper) {
  const std::size_t all = mapper.scan_records() == nullptr ? 0 : mapper.scan_records()->stamps.size();
  return all == 0 ? 0 : static_cast<int>(100 * mapper.live_trajectory().size() / all);
}

/// The line for a robot that knows no place, with what may help beyond what was given.
std::string knows_no_place_in(const slam::Mapper& mapper, const slam::MapBase& base, bool torn_log) {
  if (!mapper.live_trajectory().empty())
    return "the robot was on the map " + base.name + " for " + std::to_string(share_placed(mapper)) +
           " % of its scans and ended where it does not know its place: it left what that map shows, or was carried "
           "off; --continue adds the ground that is missing";
  const char* const log = torn_log ? "the whole log" : "a longer log";
  return "the robot does not know its place in " + base.name + ": " +
         (base.start ? std::string("check --start, or give ") + log + " or"
                     : std::string("give --start, ") + log + ", or") +
         " a map of where it drove";
}

/// ", but it began at 1.23, -0.45 m, heading 90 deg, not at --start": where the mapper found it far from what was told.
std::string other_start(const slam::Mapper& mapper, const slam::MapBase& base) {
  constexpr double kStartAway = 0.6;    // [m]
  constexpr double kStartTurned = 0.5;  // [rad]
  if (!base.start || mapper.trajectory().empty()) return "";
  const mrpt::math::TPose2D& began = mapper.trajectory().front().pose;
  if (std::hypot(began.x - base.start->x, began.y - base.start->y) <= kStartAway &&
      std::abs(wrap_angle(began.phi - base.start->phi)) <= kStartTurned)
    return "";
  std::array<char, 120> text{};
  std::snprintf(text.data(), text.size(), ", but it began at %.2f, %.2f m, heading %.0f deg, not at --start", began.x,
                began.y, rad_to_deg(began.phi));
  return text.data();
}

/// "1.23, -0.45 m, heading 90 deg, found 12.3 s after the first scan"
std::string place_found(const slam::Mapper& mapper, const slam::MapBase& base) {
  const Trajectory& live = mapper.live_trajectory();
  const bool known = !knows_no_place(mapper);
  if (live.empty() && (!known || mapper.trajectory().empty())) return "not found";
  const mrpt::math::TPose2D at = live.empty() ? mapper.trajectory().back().pose : live.front().pose;
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), "%.2f, %.2f m, heading %.0f deg, ", at.x, at.y, rad_to_deg(at.phi));
  std::string place = text.data();
  if (live.empty()) {
    place += "found when the log was over";
  } else {
    const slam::ScanRecords* scans = mapper.scan_records();
    const Stamp first = scans == nullptr || scans->stamps.empty() ? live.front().stamp : scans->stamps.front();
    std::snprintf(text.data(), text.size(), "found %.1f s after the first scan", live.front().stamp - first);
    place += text.data();
  }
  return place + (known ? "" : ", and given up again") + other_start(mapper, base);
}

/// The log's robot, with the laser where the user says that it sits.
robot::RobotModel recorded_robot(const robot::ReplayRobot& robot, const RunOptions& options) {
  robot::RobotModel model = robot.model();
  mrpt::math::TPose3D& T = model.T_base_laser;
  if (options.mount) T = {options.mount->x, options.mount->y, T.z, options.mount->phi, T.pitch, T.roll};
  if (options.upside_down) T = {T.x, T.y, T.z, T.yaw, 0.0, kPi};
  return model;
}

/// Relations and other programs know the scans of a log by its own stamps.
void name_as_the_log_does(const RunFolder& folder, const robot::ReplayRobot& robot, const slam::Mapper& mapper) {
  const auto write = [&](const char* name, const Trajectory& trajectory) {
    std::string text;
    for (const StampedPose& stamped : robot.in_own_stamps(trajectory)) text += tum_line(stamped) + '\n';
    folder.write(name, text);
  };
  write("estimate.tum", mapper.trajectory());
  write("estimate_live.tum", mapper.live_trajectory());
  if (!robot.reference().empty()) write("truth.tum", robot.reference());
}

}  // namespace

RunReport map_log(const std::string& log, const Scenario& scenario, const RunOptions& options) {
  const auto start = Clock::now();
  scenario.mapper.require_permission();
  std::vector<scoring::Relation> relations;
  if (!options.relations.empty()) relations = scoring::read_relations(options.relations);
  robot::ReplayRobot robot(log);
  if (options.note)
    for (const std::string& note : robot.notes()) options.note(note);
  Scenario resolved = scenario;
  if (resolved.name == "map") resolved.name = as_file_name("map-" + std::filesystem::path(log).stem().stem().string());
  const robot::RobotModel model = recorded_robot(robot, options);
  resolved.robot = model;
  if (const auto& known = robot::laser_names(); std::count(known.begin(), known.end(), model.laser.name) == 0)
    resolved.robot.laser.name = robot::kGenericLaser;
  RunFolder folder(folder_for(options, resolved), options.replace);
  folder.write("scenario.yaml", "# rubble map " + one_line(log) + " (" + robot.format() + ")" + base_as_typed(options) +
                                    "\n" + resolved_yaml(resolved));
  folder.write("versions.json", versions().json(2) + "\n");
  Core core(resolved, model, false, folder.path(), options.base);
  if (!robot.reference().empty()) folder.append_truth(robot.reference());
  LoopHooks hooks = hooks_of(options);
  hooks.share = [&] { return robot.progress(); };
  const LoopEnd end = Loop(resolved, folder, core, hooks).run(robot);
  if (core.mapper().counts().scans == 0 && !end.interrupted && end.failure.empty())
    throw InputError(log + ": holds no laser scan; a log to map needs scans (and odometry)");
  name_as_the_log_does(folder, robot, core.mapper());
  save_map_files(folder, core.mapper(), [&](Stamp delivered) { return robot.own_stamp(delivered); });
  scoring::Evidence evidence;
  if (!robot.reference().empty()) compare_trajectories(evidence, core.mapper(), robot.reference());
  if (!relations.empty()) {
    const Trajectory scans = robot.in_own_stamps(core.mapper().trajectory());
    evidence.relations = scoring::relation_error(scans, relations);
    const auto doubt = scoring::between_scans(scans, relations, options.relations, log);
    if (doubt && options.note) options.note(*doubt);
  }
  evidence.run = run_figures(core, end.sim_s,
                             end.interrupted || !end.failure.empty() ? end.reason
                             : robot.was_torn()                      ? "the log is cut: its torn last frame was dropped"
                             : knows_no_place(core.mapper()) ? "the log is over; its place in the map is not known"
                                                             : "the log is over");
  RunReport report;
  report.interrupted = end.interrupted;
  report.failure = end.failure;
  if (options.base) report.place = place_found(core.mapper(), *options.base);
  finish(report, evidence, folder, resolved, start);
  const bool placeless = knows_no_place(core.mapper());
  if (options.link_latest && !placeless) folder.link_latest(core.mapper());
  if (evidence.relations && evidence.relations->relations == 0 && !end.interrupted)
    report.broken.push_back(options.relations + ": none of its relations lies in the time of " + log +
                            "; give those of the same log");
  // A run that was cut short had no time to find it.
  const bool whole = !end.interrupted && end.failure.empty();
  if (placeless && whole) report.broken.push_back(knows_no_place_in(core.mapper(), *options.base, robot.was_torn()));
  if (!placeless && whole && evidence.run->area_known_m2 == 0.0)
    report.broken.push_back(log + ": nothing is mapped: none of its " + std::to_string(core.mapper().counts().scans) +
                            " scans can be used; are their ranges, angles and times right?");
  return report;
}

}  // namespace rubble::scenarios
