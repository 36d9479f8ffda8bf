#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/score_parts.h"
#include "app/score_tools.h"
#include "app/score_victims.h"
#include "base/error.h"
#include "scenarios/run/score_json.h"
#include "scoring/maps/normalise.h"
#include "scoring/pictures/picture.h"
#include "scoring/pose_score.h"
#include "scoring/scorecard.h"

namespace rubble::app {
namespace {

/// One map, the truth, and what came out.
struct Verdict {
  scoring::LoadedMap map;
  scoring::LoadedMap truth;
  scoring::MapScore score;
  ReportedVictims reported;
  std::optional<scoring::LeaguePoints> points;
};

void print_table(const Verdict& verdict) {
  const scoring::MapScore& s = verdict.score;
  const auto row = [](const char* label, const char* format, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    std::printf("%-26s %s\n", label, text);
  };
  std::printf("%-26s %s\n%-26s %s\n", "map", verdict.map.recognised.c_str(), "truth", verdict.truth.recognised.c_str());
  if (!s.aligned) std::printf("%-26s %s\n", "not aligned", s.note.c_str());
  print_contest(s);
  if (s.aligned) {
    row("known", "%.1f %%", 100.0 * s.known);
    row("psi", "%.3f m", s.psi_m);
    row("precision", "%.3f", s.precision);
    row("recall", "%.3f", s.recall);
  }
  row("score", "%.3f", s.score);
  print_victims(verdict.reported, verdict.points);
  print_parts(s);
}

nlohmann::ordered_json as_json(const Verdict& verdict) {
  nlohmann::ordered_json json;
  scenarios::add_map_score(json, verdict.score);
  json["map"] = verdict.map.recognised;
  json["truth"] = verdict.truth.recognised;
  add_parts(json, verdict.score);
  add_victims(json, verdict.reported, verdict.points);
  return json;
}

}  // namespace

int score(const ScoreArguments& arguments) {
  if (!arguments.league.empty()) return score_league(arguments);
  if (arguments.truth.empty()) throw UsageError("truth is required; see rubble score --help");
  if (!arguments.judge.empty()) throw UsageError("--judge goes with --league only; see rubble score --help");
  if (is_trajectory(arguments.map)) return score_trajectory(arguments);
  const std::optional<GivenPose> pose = parse_pose(arguments.pose);
  for (const std::string& path : {arguments.map, arguments.truth})
    if (std::filesystem::is_directory(path))
      throw InputError(path + ": is a folder; give a map file in it, for example " + path + "/map.tif");
  scoring::ScoreConfig config;
  config.alignment = parse_align(arguments.align);
  config.warp = arguments.warp;
  config.tau = arguments.tau;
  if (!arguments.out.empty()) make_folder(arguments.out);
  Verdict verdict;
  verdict.map = scoring::load_map(arguments.map, {arguments.map_resolution});
  verdict.truth = scoring::load_map(arguments.truth, {arguments.truth_resolution});
  verdict.reported = reported_victims(verdict.map, arguments.pois);
  const TrueVictims victims = true_victims(arguments.truth, verdict.truth.origin, arguments.victims);
  const OccupancyGrid& truth = verdict.truth.grid;
  const OccupancyGrid grid = pose ? scoring::scaled_frame(verdict.map.grid, pose->scale) : verdict.map.grid;
  if (pose)
    for (scoring::Poi& poi : verdict.reported.victims) poi.p_picture *= pose->scale;
  verdict.score =
      pose ? scoring::score_at(grid, truth, pose->T_truth_map, config) : scoring::score_map(grid, truth, config);
  const scoring::MapScore& result = verdict.score;
  verdict.points = victim_points(grid, truth, result, verdict.reported, victims);
  if (arguments.json) {
    std::printf("%s\n", as_json(verdict).dump(2).c_str());
  } else {
    print_table(verdict);
  }
  if (!arguments.html.empty())
    write_evaluation_page(
        arguments.html, verdict.map.grid, truth,
        {arguments.map, arguments.truth, command_of(arguments), result.T_truth_map, pose ? pose->scale : 1.0, config});
  if (!arguments.out.empty()) {
    if (result.aligned) {
      scoring::write_overlay(arguments.out + "/overlay.png", grid, truth, result.T_truth_map);
      scoring::write_error_map(arguments.out + "/error.png", grid, truth, result.T_truth_map, config.tau);
    }
    const std::string path = arguments.out + "/score.json";
    std::FILE* file = std::fopen(path.c_str(), "w");
    if (file == nullptr) throw InputError(path + ": cannot be written; give a writable folder with --out");
    const std::string text = as_json(verdict).dump(2) + "\n";
    const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    if (std::fclose(file) != 0 || !written) throw RunError(path + ": cannot be written; check the free space");
  }
  return kOk;
}

}  // namespace rubble::app
