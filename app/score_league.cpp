#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "app/score_parts.h"
#include "app/score_tools.h"
#include "base/error.h"
#include "base/text/number_text.h"
#include "base/text/text_file.h"
#include "scoring/league/league.h"
#include "scoring/league/league_files.h"
#include "scoring/league/league_page.h"
#include "scoring/maps/normalise.h"
#include "scoring/pictures/picture.h"

namespace rubble::app {
namespace {

namespace fs = std::filesystem;
using scoring::LeagueEntry;

/// Everything the teams are compared with.
struct Truth {
  std::string path;
  OccupancyGrid grid;
  scoring::TrueVictims victims;
};

Truth load_truth(const ScoreArguments& arguments) {
  Truth truth;
  truth.path = arguments.map;
  scoring::LoadedMap loaded = scoring::load_map(truth.path, {arguments.truth_resolution});
  truth.victims = scoring::true_victims(truth.path, loaded.origin, arguments.victims);
  truth.grid = std::move(loaded.grid);
  return truth;
}

/// A file name of its own for each team, whatever the team calls itself.
std::string safe_name(const std::string& team, std::size_t index) {
  std::string name;
  for (const char c : team)
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.' ? c : '_';
  char number[16];
  std::snprintf(number, sizeof number, "%03zu-", index + 1);
  return number + name;
}

class League {
 public:
  League(const ScoreArguments& arguments, const Truth& truth) : arguments_(arguments), truth_(truth) {
    config_.alignment = parse_align(arguments.align);
    config_.warp = arguments.warp;
    config_.tau = arguments.tau;
  }

  /// Judges one team; what is wrong with its files becomes its note.
  void judge(const scoring::LeagueFiles& files, double judge_points) {
    LeagueEntry entry;
    entry.team = files.team;
    entry.file = files.map;
    entry.judge = judge_points;
    entry.error = files.error;
    scoring::LeaguePictures pictures;
    if (entry.error.empty()) try {
        judge_map(files, entry, pictures);
      } catch (const InputError& error) {
        entry.error = error.what();
      }
    pictures_.emplace(entry.team + "\n" + entry.file, pictures);
    entries_.push_back(entry);
  }

  /// `skipped`: images that were taken for no team's map.
  void finish(const std::vector<std::string>& skipped) {
    scoring::rank_league(entries_);
    print();
    std::string left_out;
    for (const std::string& path : skipped) left_out += (left_out.empty() ? "" : ", ") + path;
    if (!left_out.empty()) std::printf("no team's maps: %s\n", left_out.c_str());
    if (arguments_.out.empty()) return;
    std::vector<scoring::LeaguePictures> pictures;
    for (const LeagueEntry& entry : entries_) pictures.push_back(pictures_.at(entry.team + "\n" + entry.file));
    write_text_file(arguments_.out + "/league.csv", scoring::league_csv(entries_));
    write_text_file(arguments_.out + "/league.html",
                    scoring::league_page(truth_.path, with_points(), entries_, pictures, left_out));
    std::printf("written: %s/league.html, league.csv\n", arguments_.out.c_str());
  }

 private:
  bool with_points() const {
    return std::any_of(entries_.begin(), entries_.end(),
                       [](const LeagueEntry& e) { return e.points || e.judge > 0.0; });
  }

  void judge_map(const scoring::LeagueFiles& files, LeagueEntry& entry, scoring::LeaguePictures& pictures) {
    const scoring::LoadedMap loaded = scoring::load_map(files.map, {arguments_.map_resolution, false});
    const OccupancyGrid& map = loaded.grid;
    entry.reported = scoring::reported_victims(loaded, files.pois);
    if (!entry.reported.note.empty()) std::fprintf(stderr, "rubble: %s\n", entry.reported.note.c_str());
    entry.score = scoring::score_map(map, truth_.grid, config_);
    if (scoring::same_content(files.map, truth_.path))
      entry.score.note += std::string(entry.score.note.empty() ? "" : "; ") + "a copy of the truth, byte for byte";
    entry.points = scoring::victim_points(map, truth_.grid, entry.score, entry.reported, truth_.victims);
    if (!arguments_.out.empty()) draw(entry, map, pictures);
  }

  void draw(const LeagueEntry& entry, const OccupancyGrid& map, scoring::LeaguePictures& pictures) const {
    const std::string name = safe_name(entry.team, entries_.size());
    if (entry.score.aligned || !entry.score.source.empty()) {
      pictures.overlay = name + "-overlay.png";
      scoring::write_overlay(arguments_.out + "/" + pictures.overlay, map, truth_.grid, entry.score.T_truth_map,
                             entry.score.aligned ? "" : "NOT TRUSTED: " + entry.score.note);
    }
    if (entry.score.aligned) {
      pictures.error = name + "-error.png";
      scoring::write_error_map(arguments_.out + "/" + pictures.error, map, truth_.grid, entry.score.T_truth_map,
                               config_.tau);
    }
    pictures.tool = name + ".html";
    write_text_file(arguments_.out + "/" + pictures.tool,
                    scoring::evaluation_page(map, truth_.grid,
                                             {entry.file, truth_.path, "rubble score " + entry.file + " " + truth_.path,
                                              entry.score.T_truth_map, 1.0, config_}));
  }

  void print() const {
    const bool points = with_points();
    std::size_t width = 4;
    for (const LeagueEntry& e : entries_) width = std::max(width, e.team.size());
    const int w = static_cast<int>(width);
    std::printf("%4s  %-*s%s", "rank", w, "team", points ? "  points quality location  fine judge victims by" : "");
    std::vector<const scoring::Figure*> columns = scoring::figures_with(scoring::kRanking);
    if (config_.warp) columns.push_back(scoring::find_figure("warped_score"));
    for (const scoring::Figure* column : columns) std::printf("  %s", column->label.c_str());
    std::printf("  note\n");
    for (const LeagueEntry& e : entries_) {
      std::printf("%4d  %-*s", e.rank, w, e.team.c_str());
      if (!e.error.empty()) {
        std::printf("  %s\n", e.error.c_str());
        continue;
      }
      if (points)
        std::printf("  %6.1f %7.1f %8.1f %5.1f %5.1f %-10s", e.total(), e.points ? e.points->quality : 0.0,
                    e.points ? e.points->location : 0.0, e.points ? e.points->fine : 0.0, e.judge,
                    scoring::name_of(e.reported.from).c_str());
      const scoring::Evidence evidence = e.evidence();
      for (const scoring::Figure* column : columns)
        std::printf("  %*s", static_cast<int>(column->label.size()),
                    scoring::text_of(*column, column->get(evidence)).c_str());
      std::printf("  %s\n", e.score.note.c_str());
    }
  }

  const ScoreArguments& arguments_;
  const Truth& truth_;
  scoring::ScoreConfig config_;
  std::vector<LeagueEntry> entries_;
  std::map<std::string, scoring::LeaguePictures> pictures_;  // of team and file
};

void check(const ScoreArguments& arguments) {
  if (!arguments.truth.empty())
    throw UsageError("--league needs the truth only: rubble score --league DIR TRUTH; see rubble score --help");
  if (!arguments.pose.empty() || !arguments.pois.empty() || !arguments.html.empty() || arguments.json)
    throw UsageError("--league goes without --pose, --pois, --html and --json; pages and CSV are written with --out");
}

/// The judge's points of teams that are there, no more than 30 a victim.
std::map<std::string, double> judge_of(const ScoreArguments& arguments, const Truth& truth,
                                       const std::vector<scoring::LeagueFiles>& teams) {
  std::map<std::string, double> judge;
  if (!arguments.judge.empty()) judge = scoring::read_judge(arguments.judge);
  const double most = scoring::kJudgesMostPerVictim * static_cast<double>(truth.victims.victims.size());
  for (const auto& [team, points] : judge) {
    if (std::none_of(teams.begin(), teams.end(), [&](const scoring::LeagueFiles& files) { return files.team == team; }))
      throw InputError(arguments.judge + ": names team '" + team + "', but " + arguments.league +
                       " holds no map of that name");
    if (!truth.victims.path.empty() && points > most)
      throw InputError(arguments.judge + ": gives '" + team + "' " + number_text(points) + " points, but " +
                       std::to_string(truth.victims.victims.size()) + " victims are worth " + number_text(most) +
                       " at the most");
  }
  return judge;
}

/// Pages and pictures of teams from an earlier call: beside its league.csv, "001-..." with the endings that draw()
/// gives.
void remove_old_pages(const std::string& folder) {
  if (!std::filesystem::exists(folder + "/league.csv")) return;
  std::vector<std::filesystem::path> old;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const auto ends = [&](const std::string& end) {
      return name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
    };
    const bool numbered = name.size() > 4 && name[3] == '-' && std::all_of(name.begin(), name.begin() + 3, [](char c) {
                            return std::isdigit(static_cast<unsigned char>(c)) != 0;
                          });
    if (numbered && (ends(".html") || ends("-overlay.png") || ends("-error.png"))) old.push_back(entry.path());
  }
  for (const auto& path : old) std::filesystem::remove(path);
}

}  // namespace

int score_league(const ScoreArguments& arguments) {
  check(arguments);
  const Truth truth = load_truth(arguments);
  const scoring::LeagueFolder folder = scoring::find_league(arguments.league, truth.path);
  const std::vector<scoring::LeagueFiles>& teams = folder.teams;
  const std::map<std::string, double> judge = judge_of(arguments, truth, teams);
  if (!arguments.out.empty()) {
    make_folder(arguments.out);
    remove_old_pages(arguments.out);
  }
  League league(arguments, truth);
  for (const scoring::LeagueFiles& files : teams) {
    const auto points = judge.find(files.team);
    league.judge(files, points == judge.end() ? 0.0 : points->second);
  }
  league.finish(folder.skipped);
  return kOk;
}

}  // namespace rubble::app
