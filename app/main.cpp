// The command line: parses, dispatches, and turns every failure into one line and an exit code.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <new>
#include <sstream>

#include "app/batch.h"
#include "app/commands.h"
#include "base/error.h"
#include "base/text/words.h"
#include "scenarios/run/run.h"

namespace rubble::app {
namespace {

/// A number from low to high; unlike CLI::Range it refuses NaN.
CLI::Validator between(double low, double high) {
  const auto check = [low, high](const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end != text.c_str() && *end == '\0' && value >= low && value <= high) return std::string();
    std::ostringstream message;
    message << "'" << text << "' is not a number from " << low << " to " << high;
    return message.str();
  };
  return CLI::Validator(check, "");
}

/// 0 to 2^63 - 1 without a sign.
CLI::Validator whole_number() {
  const auto check = [](const std::string& text) {
    std::int64_t value = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool good = end.ec == std::errc() && end.ptr == text.data() + text.size() && value >= 0;
    return good ? std::string() : "'" + text + "' is not a whole number from 0 on";
  };
  return CLI::Validator(check, "");
}

void add_common(CLI::App& command, CommonOptions& common, std::vector<std::string>& sets) {
  command.add_option("--out", common.out, "Folder for the results (default: runs/NAME-seedN-NUMBER)");
  command.add_flag("--force", common.force, "Replace an existing run folder");
  command.add_option("--set", sets, "Override one value: --set key.key=value (repeatable)")
      ->allow_extra_args(false)
      ->take_all();
}

std::vector<scenarios::Override> parse_sets(const std::vector<std::string>& sets) {
  std::vector<scenarios::Override> overrides;
  for (const auto& set : sets) {
    const auto equals = set.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError("--set " + set + ": needs the form key.key=value, for example --set robot.levelling=false");
    overrides.emplace_back(set.substr(0, equals), set.substr(equals + 1));
  }
  return overrides;
}

void add_generate(CLI::App& command, ArenaArguments& arena, std::string& cells) {
  command.add_option("--kind", arena.config.kind, "Kind of arena")->check(CLI::IsMember({"yellow", "orange", "red"}));
  command.add_option("--cells", cells, "Pallets west-east x south-north (default 8x8)");
  command.add_option("--seed", arena.config.seed, "Seed of the layout")->check(whole_number());
  command.add_option("--ramps", arena.config.ramps, "Share of pallets that are ramps, 0..1")->check(between(0.0, 1.0));
  command
      .add_option("--rough", arena.config.rough, "Share of pallets with obstacles (orange, red), 0..1, default 0.25")
      ->check(between(0.0, 1.0));
  command.add_option("--paper", arena.config.paper, "Share of pallets with paper, 0..1")->check(between(0.0, 1.0));
  command.add_option("--loops", arena.config.loops, "Share of inner walls taken away, 0..1")->check(between(0.0, 1.0));
  command.add_option("--victims", arena.config.victims, "Number of victims");
}

void parse_cells(const std::string& cells, arenas::GenerateConfig& config) {
  if (cells.empty()) return;
  char rest = 0;
  if (std::sscanf(cells.c_str(), "%dx%d%c", &config.columns, &config.rows, &rest) != 2)
    throw UsageError("--cells " + cells + ": needs the form COLUMNSxROWS, for example --cells 10x12");
  if (std::min(config.columns, config.rows) < 2 || std::max(config.columns, config.rows) > 60)
    throw UsageError("--cells " + cells + ": an arena has 2 to 60 pallets a side");
}

/// The generator's options say nothing about an arena that is read from a file.
void refuse_generator_options(const CLI::App& command) {
  for (const char* name : {"--kind", "--cells", "--seed", "--ramps", "--rough", "--paper", "--loops", "--victims"})
    if (command.count(name) > 0)
      throw UsageError(std::string(name) + " is for 'rubble arena generate'; an arena file has its own layout");
}

int dispatch(int argc, char** argv) {
  CLI::App app(
      "rubble: simulate, map and score rescue arenas.\n"
      "Exit codes: 0 ok, 1 an expectation failed, 2 usage, 3 bad input, 4 run failed, 130 interrupted.");
  app.name("rubble");
  app.set_version_flag("--version", [] { return scenarios::versions().dump(); });
  app.require_subcommand(1);
  std::vector<std::string> sets;
  std::int64_t seed = 0;

  RunArguments run_arguments;
  CLI::App* run_command = app.add_subcommand("run", "Explore, map and score an arena in simulation");
  run_command->add_option("scenario", run_arguments.scenario,
                          "Scenario file, or the name of a shipped one (default: yellow)");
  CLI::Option* run_seed = run_command->add_option("--seed", seed, "Seed of every random choice")->check(whole_number());
  add_common(*run_command, run_arguments.common, sets);
  run_command->footer(
      "Examples:\n  rubble run\n  rubble run scenarios/yellow.yaml --seed 7\n"
      "  rubble run --set robot.levelling=false --out runs/no-levelling");

  MapArguments map_arguments;
  CLI::App* map_command =
      app.add_subcommand("map", "Map a recorded log (own log, MRPT .rawlog, CARMEN, CoreSLAM .dat)");
  map_command->add_option("log", map_arguments.log, "Log file")->required();
  CLI::Option* map_seed = map_command->add_option("--seed", seed, "Seed of the particle filter")->check(whole_number());
  add_common(*map_command, map_arguments.common, sets);
  map_command->footer("Examples:\n  rubble map intel.log.gz\n  rubble map lab.rawlog --set mapper.resolution_m=0.1");

  ScoreArguments score_arguments;
  CLI::App* score_command = app.add_subcommand("score", "Align a map to the ground truth and score it");
  score_command
      ->add_option("map", score_arguments.map, "GeoTIFF, ROS map.yaml, image with --resolution, or trajectory .tum")
      ->required();
  score_command->add_option("truth", score_arguments.truth,
                            "Ground truth, same formats (for a trajectory also .relations)");
  score_command->add_option("--pose", score_arguments.pose,
                            "Score at this pose, X,Y,DEG[,SCALE], instead of aligning (write --pose=-1,2,90)");
  score_command->add_option("--html", score_arguments.html,
                            "Write a page to move, turn, scale and blend the two maps by hand");
  score_command->add_option("--league", score_arguments.league,
                            "Rank all maps of this folder against one truth: rubble score --league DIR TRUTH");
  score_command->add_option("--victims", score_arguments.victims,
                            "True victims: arena file or CSV name,x,y (default: beside the truth)");
  score_command->add_option("--pois", score_arguments.pois,
                            "CSV of the victims that the map reports (default: the symbols drawn on it)");
  score_command->add_option("--judge", score_arguments.judge, "CSV team,points of the judge's points, for --league");
  score_command
      ->add_option("--resolution", score_arguments.map_resolution,
                   "Metres a pixel of the map image; in a league of images that do not say")
      ->check(between(0.001, 10.0));
  score_command->add_option("--truth-resolution", score_arguments.truth_resolution, "Metres a pixel of the truth image")
      ->check(between(0.001, 10.0));
  score_command->add_option("--tau", score_arguments.tau, "Distance at which a wall counts nothing [m]")
      ->check(between(0.05, 10.0));
  score_command->add_option(
      "--align", score_arguments.align,
      "What proposes poses: auto, or walls, rooms and one of features, surf, akaze, orb, joined by commas");
  score_command->add_flag("--warp", score_arguments.warp, "Also undo the map's distortion, and match its features");
  score_command->add_option("--out", score_arguments.out, "Folder for overlay.png, error.png and score.json");
  score_command->add_flag("--json", score_arguments.json, "Print JSON");
  score_command->footer(
      "Examples:\n  rubble score runs/latest/map.tif runs/latest/truth.tif\n"
      "  rubble score team.png truth.tif --resolution 0.05 --out judged\n"
      "  rubble score team.tif truth.tif --html judge.html\n"
      "  rubble score --league maps/ truth.tif --out judged\n"
      "  rubble score runs/latest/estimate.tum runs/latest/truth.tum");

  ReplayArguments replay_arguments;
  CLI::App* replay_command =
      app.add_subcommand("replay", "Run the mapper again on a recorded run and compare bit by bit");
  replay_command->add_option("run", replay_arguments.run, "Run folder")->required();
  replay_command->add_option("--out", replay_arguments.out, "Keep the re-made artefacts in this folder");
  replay_command->footer("Example:\n  rubble replay runs/latest");

  ExportArguments export_arguments;
  CLI::App* export_command = app.add_subcommand("export", "Write a recorded log as MRPT .rawlog");
  export_command
      ->add_option("log", export_arguments.log,
                   "Recorded log: a run folder, or a log file of any format that `map` reads")
      ->required();
  export_command->add_option("out", export_arguments.out, "The .rawlog to write")->required();
  export_command->footer("Example:\n  rubble export runs/latest/log.rlog run.rawlog");

  ArenaArguments arena_arguments;
  std::string cells;
  CLI::App* arena_command =
      app.add_subcommand("arena", "Picture and truth map of an arena file, or of a generated arena");
  arena_command->add_option("file", arena_arguments.file, "Arena file, or the word 'generate'")->required();
  add_generate(*arena_command, arena_arguments, cells);
  arena_command->add_option("--resolution", arena_arguments.resolution, "Metres a pixel of the truth map")
      ->check(between(0.005, 1.0));
  arena_command
      ->add_option("--slice-height", arena_arguments.slice_height,
                   "Height above each floor at which the truth map is cut, default 0.35 [m]")
      ->check(between(0.01, 5.0));
  arena_command
      ->add_option("--range", arena_arguments.range, "How far the laser sees of NAME-visible.tif, default 4 [m]")
      ->check(between(0.1, 100.0));
  arena_command->add_option("--walls", arena_arguments.walls,
                            "Also write the walls as lines: FILE.csv or FILE.geojson");
  arena_command->add_flag_callback(
      "--elements",
      [] {
        list_elements();
        throw CLI::Success();
      },
      "List the league's parts that arena files can place, and what they are");
  arena_command->add_option("--out", arena_arguments.out, "Folder for the files (default: here)");
  arena_command->footer(
      "Examples:\n  rubble arena arenas/shipped/yellow_8x8.yaml\n"
      "  rubble arena arenas/shipped/yellow_8x8.yaml --resolution 0.02 --slice-height 0.2 --walls walls.geojson\n"
      "  rubble arena generate --cells 10x12 --seed 3 --ramps 0.4 --paper 0.2 --victims 6 --loops 0.2");

  BatchCommands batch_commands(app);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version, --elements
    std::string message = error.what();
    std::replace(message.begin(), message.end(), '\n', ' ');
    const auto chosen = app.get_subcommands();
    if (chosen.empty() && argc > 1 && argv[1][0] != '-')
      throw UsageError("'" + std::string(argv[1]) + "' is no subcommand; see rubble --help");
    const std::string command = chosen.empty() ? "" : " " + chosen.front()->get_name();
    throw UsageError(message + "; see rubble" + command + " --help");
  }
  if (*run_seed) run_arguments.seed = static_cast<std::uint64_t>(seed);
  if (*map_seed) map_arguments.seed = static_cast<std::uint64_t>(seed);
  run_arguments.common.overrides = map_arguments.common.overrides = parse_sets(sets);
  arena_arguments.generate = arena_arguments.file == "generate";
  parse_cells(cells, arena_arguments.config);
  if (arena_arguments.config.kind == "yellow" && arena_command->count("--rough") > 0)
    throw UsageError("--rough: a yellow arena has no obstacles; add --kind orange or --kind red");
  if (*arena_command && !arena_arguments.generate) refuse_generator_options(*arena_command);
  if (const auto code = batch_commands.run()) return *code;
  if (*run_command && run_command->count("scenario") > 0 && run_arguments.scenario.empty())
    throw UsageError("run '': is no scenario; give a file or a name, or leave it out for the main job");
  if (*run_command) return run(run_arguments);
  if (*map_command) return map(map_arguments);
  if (*score_command) return score(score_arguments);
  if (*replay_command) return replay(replay_arguments);
  if (*export_command) return export_log(export_arguments);
  return arena(arena_arguments);
}

/// One line whatever stands in it: names and values of foreign files may hold line breaks and terminal escapes.
int complain(const std::string& message, int code) {
  std::fprintf(stderr, "rubble: %s\n", one_line(message).c_str());
  return code;
}

/// A path that cannot be looked at is bad input, a disk that fails is not.
int complain(const std::filesystem::filesystem_error& error) {
  const std::error_code why = error.code();
  const bool is_disk = why == std::errc::no_space_on_device || why == std::errc::io_error;
  return complain(error.path1().string() + ": cannot be used (" + why.message() +
                      "); check the path, its permissions and the free space",
                  is_disk ? kFailed : kBadInput);
}

/// What was printed counts only when it arrived.
int delivered(int code) {
  std::cout.flush();
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return code;
  if (code != kOk && code != kBroken) return code;  // it has had its one line
  const std::string why = errno != 0 ? std::string(" (") + std::strerror(errno) + ")" : "";
  return complain("standard output: cannot be written" + why + "; free some space and give the command again", kFailed);
}

int guarded(int argc, char** argv) {
  try {
    return dispatch(argc, argv);
  } catch (const UsageError& error) {
    return complain(error.what(), kUsage);
  } catch (const InputError& error) {
    return complain(error.what(), kBadInput);
  } catch (const std::filesystem::filesystem_error& error) {
    return complain(error);
  } catch (const std::bad_alloc&) {
    std::fputs("rubble: out of memory; use a coarser mapper.resolution_m or a smaller map\n", stderr);
    return kFailed;
  } catch (const std::exception& error) {
    return complain(error.what(), kFailed);
  }
}

}  // namespace
}  // namespace rubble::app

int main(int argc, char** argv) { return rubble::app::delivered(rubble::app::guarded(argc, argv)); }
