#include <algorithm>
#include <cctype>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/commands.h"
#include "app/maps/score_parts.h"
#include "app/maps/score_tools.h"
#include "app/terminal.h"
#include "base/error.h"
#include "base/text/shell.h"
#include "base/text/text_file.h"
#include "scenarios/run/recorded_log.h"
#include "scenarios/run/score_json.h"
#include "scoring/league/league_victims.h"
#include "scoring/maps/normalise.h"
#include "scoring/marks.h"
#include "scoring/pictures/picture.h"
#include "scoring/pictures/sight_picture.h"
#include "scoring/pose_score.h"
#include "scoring/room_report.h"
#include "scoring/scorecard.h"

namespace rubble::app {
namespace {

/// One map, the truth, and what came out.
struct Verdict {
  scoring::LoadedMap map;
  scoring::LoadedMap truth;
  scoring::MapScore score;
  scoring::ReportedVictims reported;
  std::optional<scoring::LeaguePoints> points;
};

/// A page scales the map's marks with the map.
std::vector<scoring::Marks> in_own_scale(std::vector<scoring::Marks> all, double scale) {
  const auto shrink = [scale](scoring::Mark& mark) {
    mark.p *= 1.0 / scale;
    if (!mark.box) return;
    mark.box->first *= 1.0 / scale;
    mark.box->second *= 1.0 / scale;
  };
  for (scoring::Marks& marks : all) {
    for (auto& [map, truth] : marks.pairs) shrink(map);
    for (scoring::Mark& map : marks.map_only) shrink(map);
    for (scoring::Mark& map : marks.unjudged) shrink(map);
  }
  return all;
}

/// "matches_surf.png" and the like.
std::string file_of(const scoring::Marks& marks) {
  std::string name = "matches_" + marks.what + ".png";
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

/// `grid`: the map as it was laid on the truth.
nlohmann::ordered_json as_json(const Verdict& verdict, const OccupancyGrid& grid) {
  scoring::Evidence evidence;
  evidence.score = verdict.score;
  evidence.map = &grid;
  evidence.truth = &verdict.truth.grid;
  evidence.map_read_as = verdict.map.recognised;
  evidence.truth_read_as = verdict.truth.recognised;
  evidence.victims = scoring::victim_figures(verdict.reported, verdict.points);
  return scenarios::score_json(evidence);
}

/// What a person can do with a map that was refused; nothing helps one that has no walls. `knows_start`: --start was
/// given.
std::string how_to_go_on(const Verdict& verdict, bool knows_start) {
  const auto& cells = verdict.map.grid.cells();
  if (std::find(cells.begin(), cells.end(), Occupancy::Occupied) == cells.end()) return {};
  std::string out = "--html PAGE.html lays it by hand in a browser, --pose=X,Y,DEG scores it where you say";
  const scoring::MapOrigin origin = verdict.map.origin;
  const bool from_start = origin == scoring::MapOrigin::Ros || origin == scoring::MapOrigin::Local;
  if (from_start && !knows_start && verdict.score.by != scoring::AlignBy::Auto)
    out +=
        "; --start=X,Y,DEG says where in the truth the robot started, which decides between poses that fit about as "
        "well";
  return out;
}

/// `knows_start`: --start was given.
void print_table(const Verdict& verdict, const nlohmann::ordered_json& json, bool knows_start) {
  print_row("map", verdict.map.recognised);
  print_row("truth", verdict.truth.recognised);
  const scoring::MapScore& score = verdict.score;
  if (!score.aligned) {
    print_not_aligned(score.note);
    if (const std::string how = how_to_go_on(verdict, knows_start); !how.empty()) print_row("to go on", how);
  }
  if (score.aligned && !score.note.empty()) print_row("aligned", score.note);
  print_contest(verdict.score);
  print_figures(json, true);
  const scoring::ReportedVictims& reported = verdict.reported;
  if (reported.from != scoring::VictimSource::None)
    print_row("victims reported", std::to_string(reported.victims.size()) + " from " + name_of(reported.from) + ", " +
                                      std::to_string(reported.symbols) + " symbols on the map");
  print_victims(json);
  print_worst_places(verdict.score);
}

int score(ScoreArguments arguments) {
  if (arguments.map.empty())
    throw UsageError(arguments.league.empty()
                         ? "map is required; see rubble score --help"
                         : "the truth is missing: rubble score --league " + shell_word(arguments.league) + " TRUTH");
  if (!arguments.league.empty()) return score_league(arguments);
  if (arguments.truth.empty()) throw UsageError("truth is required; see rubble score --help");
  if (!arguments.judge.empty()) throw UsageError("--judge goes with --league only; see rubble score --help");
  arguments.map = map_file(arguments.map);
  arguments.truth = map_file(arguments.truth, "truth.tif");
  scenarios::require_truth(arguments.truth);
  if (is_trajectory(arguments.map)) return score_trajectory(arguments);
  const std::optional<GivenPose> pose = parse_pose(arguments.pose);
  if (pose && (arguments.align != "auto" || !arguments.start.empty()))
    throw UsageError("--pose goes without --align and --start, which look for a pose; see rubble score --help");
  scoring::ScoreConfig config;
  config.alignment = parse_align(arguments.align);
  config.warp = arguments.warp;
  config.tau = arguments.tau;
  if (!arguments.out.empty()) make_score_folder(arguments.out, arguments.force);
  Verdict verdict;
  verdict.map = scoring::load_map(arguments.map, {arguments.map_resolution});
  config.alignment.start = parse_start(arguments.start, arguments.map, verdict.map);
  verdict.truth = scoring::load_map(arguments.truth, {arguments.truth_resolution});
  verdict.reported = scoring::reported_victims(verdict.map, arguments.pois);
  if (!verdict.reported.note.empty()) tell(verdict.reported.note);
  if (!verdict.truth.symbols.empty() && verdict.map.symbols.empty())
    tell(arguments.truth +
         ": has a robot's victims drawn on it, and the map has none; if the two were exchanged, give " +
         arguments.truth + " first");
  const scoring::TrueVictims victims = scoring::true_victims(arguments.truth, verdict.truth.origin, arguments.victims);
  if (victims.path.empty() && !verdict.reported.victims.empty())
    tell(arguments.truth +
         ": there is no list of the true victims beside it, so the reported ones are not judged; give it with "
         "--victims (a run keeps it in arena.yaml)");
  const OccupancyGrid& truth = verdict.truth.grid;
  const OccupancyGrid grid = pose ? scoring::scaled_frame(verdict.map.grid, pose->scale) : verdict.map.grid;
  if (pose)
    for (scoring::Poi& poi : verdict.reported.victims) poi.p_picture *= pose->scale;
  verdict.score =
      pose ? scoring::score_at(grid, truth, pose->T_truth_map, config) : scoring::score_map(grid, truth, config);
  const scoring::MapScore& result = verdict.score;
  verdict.points = scoring::victim_points(grid, truth, result, verdict.reported, victims);
  const nlohmann::ordered_json json = as_json(verdict, grid);
  if (arguments.json) {
    print_json(json);
  } else {
    print_table(verdict, json, !arguments.start.empty());
  }
  const scoring::Marks marks =
      scoring::marks_on_overlay(result, verdict.reported.victims, victims.victims, !victims.path.empty());
  scoring::Marks rooms;
  if (result.warped && (!arguments.html.empty() || !arguments.out.empty()))
    rooms = scoring::room_marks(grid, truth, scoring::rooms_of_map(truth, false), result.T_truth_map);
  if (!arguments.html.empty())
    write_evaluation_page(arguments.html, verdict.map.grid, truth,
                          {arguments.map, arguments.truth, command_of(arguments), result.T_truth_map,
                           pose ? pose->scale : 1.0, config, result.aligned ? "" : scoring::reason_of(result.note),
                           in_own_scale(scoring::marks_on_page(result, marks, rooms), pose ? pose->scale : 1.0),
                           result.score_at_best_pose, result.by, marks.seam});
  if (!arguments.out.empty()) {
    // A map that was refused is drawn at the best pose, so that a person can see why; score.json says that too.
    if (result.aligned || result.by != scoring::AlignBy::Auto)
      scoring::write_overlay(place_in(arguments.out, "overlay.png"), grid, truth, result.T_truth_map,
                             result.aligned ? "" : "NOT TRUSTED: " + scoring::reason_of(result.note), marks);
    else
      scoring::write_side_by_side(place_in(arguments.out, "overlay.png"), grid, truth, std::nullopt, {}, result.note);
    for (const scoring::Marks& features : scoring::marks_on_page(result, {}, rooms))
      scoring::write_side_by_side(place_in(arguments.out, file_of(features)), grid, truth, result.T_truth_map, features,
                                  result.aligned ? "" : "NOT TRUSTED: " + scoring::reason_of(result.note));
    if (result.aligned) {
      scoring::write_error_map(place_in(arguments.out, "error.png"), grid, truth, result.T_truth_map, config.tau);
      scoring::write_sight_map(place_in(arguments.out, "sight.png"), grid, truth, result.T_truth_map);
    }
    write_text_file(place_in(arguments.out, "score.json"), json.dump(2) + "\n");
  }
  if (!arguments.fail_under || (result.aligned && result.score >= *arguments.fail_under)) return kOk;
  char bound[32];
  std::snprintf(bound, sizeof bound, "%g", *arguments.fail_under);
  tell(arguments.map + (result.aligned ? std::string(": the score is below ") + bound + " (--fail-under)"
                                       : ": is not aligned (--fail-under)"));
  return kBroken;
}

}  // namespace

Command score_command() {
  return {"score", "Align a map to the ground truth and score it",
          "Examples:\n  rubble score runs/latest/map.tif runs/latest/truth.tif\n"
          "  rubble score team.png truth.tif --resolution 0.05 --out judged\n"
          "  rubble score team.tif truth.tif --html judge.html\n"
          "  rubble score team.tif truth.tif --fail-under 0.8\n"
          "  rubble score --league maps/ truth.tif --out judged\n"
          "  rubble score runs/latest/estimate.tum runs/latest/truth.tum",
          [](Options& o) -> Action {
            auto a = std::make_shared<ScoreArguments>();
            o.argument("map", a->map, "GeoTIFF, ROS map.yaml, image with --resolution, or trajectory .tum",
                       Options::Need::Optional);
            o.argument("truth", a->truth, "Ground truth, same formats (for a trajectory also .relations)",
                       Options::Need::Optional);
            o.text("--pose", a->pose,
                   "Score at this pose, X,Y,DEG[,SCALE], instead of aligning (write --pose=-1,2,90)");
            o.text("--start", a->start,
                   "Where the robot started in the truth, X,Y,DEG: decides between poses that fit about as well");
            o.text("--html", a->html, "Write a page to move, turn, scale and blend the two maps by hand");
            o.text("--league", a->league,
                   "Rank all maps of this folder against one truth: rubble score --league DIR TRUTH");
            o.text("--victims", a->victims, "True victims: arena file or CSV name,x,y (default: beside the truth)");
            o.text("--pois", a->pois, "CSV of the victims that the map reports (default: the symbols drawn on it)");
            o.text("--judge", a->judge, "CSV team,points of the judge's points, for --league");
            o.number("--resolution", a->map_resolution, 0.001, 10.0,
                     "Metres a pixel of the map image; in a league of images that do not say");
            o.number("--truth-resolution", a->truth_resolution, 0.001, 10.0, "Metres a pixel of the truth image");
            o.number("--tau", a->tau, 0.05, 10.0, "Distance at which a wall counts nothing [m]");
            o.text("--align", a->align,
                   "What proposes poses: auto, or walls, rooms and one of features, surf, akaze, orb, joined by "
                   "commas; eq7: of all that, the least error of eq. (7)");
            o.flag("--warp", a->warp, "Also undo the map's distortion, and match its features");
            o.text("--out", a->out, "Folder for overlay.png, error.png, sight.png and score.json");
            o.flag("--force", a->force, "Replace the pictures and score.json of a run");
            o.number("--fail-under", a->fail_under, 0.0, 1.0,
                     "End with exit code 1 if the score is lower or the map is not aligned; without it such a map, "
                     "whose score is 0, ends with 0 as well");
            o.flag("--json", a->json, "Print JSON");
            return [a] { return score(*a); };
          }};
}

}  // namespace rubble::app
