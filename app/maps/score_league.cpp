#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "app/maps/score_parts.h"
#include "app/maps/score_tools.h"
#include "app/terminal.h"
#include "base/error.h"
#include "base/text/words.h"
#include "scoring/league/league_judge.h"

namespace rubble::app {
namespace {

using scoring::LeagueEntry;

void check_options(const ScoreArguments& arguments) {
  if (!arguments.truth.empty())
    throw UsageError("--league needs the truth only: rubble score --league DIR TRUTH; see rubble score --help");
  if (!arguments.pose.empty() || !arguments.pois.empty() || !arguments.html.empty() || arguments.json ||
      arguments.force || arguments.fail_under)
    throw UsageError(
        "--league goes without --pose, --pois, --html, --force, --fail-under and --json; pages and CSV are written "
        "with --out");
}

void print_ranking(const scoring::League& league, bool warp) {
  const bool points = league.with_points();
  std::size_t width = 4;
  for (const LeagueEntry& e : league.entries) width = std::max(width, one_line(e.team).size());
  const int w = static_cast<int>(width);
  std::printf("%4s  %-*s", "rank", w, "team");
  std::vector<const scoring::Figure*> columns = scoring::figures_with(scoring::kRanking);
  if (warp) columns.push_back(scoring::find_figure("warped_score"));
  for (const scoring::Figure* column : columns) std::printf("  %s", column->label.c_str());
  std::printf("%s  note\n", points ? "  points quality location  fine judge victims by" : "");
  for (const LeagueEntry& e : league.entries) {
    std::printf("%4s  %-*s", e.rank_text().c_str(), w, one_line(e.team).c_str());
    if (!e.error.empty()) {
      std::printf("  %s\n", one_line(e.error).c_str());
      continue;
    }
    const scoring::Evidence evidence = e.evidence();
    for (const scoring::Figure* column : columns)
      std::printf("  %*s", static_cast<int>(column->label.size()), e.text_of(*column, evidence).c_str());
    if (points)
      std::printf("  %6.1f %7.1f %8.1f %5.1f %5.1f %-10s", e.total(), e.points ? e.points->quality : 0.0,
                  e.points ? e.points->location : 0.0, e.points ? e.points->fine : 0.0, e.judge,
                  scoring::name_of(e.reported.from).c_str());
    std::printf("  %s\n", one_line(e.score.note).c_str());
  }
  if (!league.left_out.empty()) print_line("no team's maps: " + league.left_out);
}

}  // namespace

int score_league(const ScoreArguments& arguments) {
  check_options(arguments);
  const scoring::LeagueTruth truth =
      scoring::load_league_truth(arguments.map, arguments.truth_resolution, arguments.victims);
  const scoring::LeagueFolder folder = scoring::find_league(arguments.league, truth.path);
  const std::map<std::string, double> judge =
      scoring::judges_points(arguments.judge, arguments.league, truth, folder.teams);
  if (!arguments.out.empty()) make_folder(arguments.out);
  scoring::LeagueConfig config;
  config.score.alignment = parse_align(arguments.align);
  config.score.warp = arguments.warp;
  config.score.tau = arguments.tau;
  config.map_resolution = arguments.map_resolution;
  config.truth_resolution = arguments.truth_resolution;
  config.out = arguments.out;
  config.tell = [](const std::string& note) { tell(note); };
  const scoring::League league = scoring::judge_league(folder, truth, judge, config);
  print_ranking(league, arguments.warp);
  if (!arguments.out.empty()) {
    scoring::write_league(league, truth, arguments.out);
    print_line("written: " + arguments.out + "/league.html, league.csv");
  }
  const bool any = std::any_of(league.entries.begin(), league.entries.end(),
                               [](const LeagueEntry& entry) { return entry.error.empty(); });
  if (!any) throw InputError(arguments.league + ": none of its maps can be read; the table says why");
  return kOk;
}

}  // namespace rubble::app
