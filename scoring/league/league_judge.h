#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scoring/league/league.h"
#include "scoring/league/league_files.h"
#include "scoring/league/league_page.h"
#include "scoring/league/league_victims.h"

namespace rubble::scoring {

/// Everything the teams are compared with.
struct LeagueTruth {
  std::string path;
  OccupancyGrid grid;
  TrueVictims victims;
};

/// `victims`: list of the true victims; empty: the one beside the map, if any. Throws InputError.
LeagueTruth load_league_truth(const std::string& path, const std::optional<double>& resolution,
                              const std::string& victims);

struct Rooms;

struct LeagueConfig {
  ScoreConfig score;
  std::optional<double> map_resolution;          ///< of maps that do not tell their scale [m] a pixel
  std::optional<double> truth_resolution;        ///< what the truth was read with, for the commands on the pages
  std::string out;                               ///< folder for a page and pictures of each team; empty: none are made
  std::shared_ptr<const Rooms> truth_rooms;      ///< where pages show rooms; null: judge_league() finds them
  std::function<void(const std::string&)> tell;  ///< what a person should know of a team's files, one line
};

/// A league that was judged, ranked.
struct League {
  std::vector<LeagueEntry> entries;
  std::vector<LeaguePictures> pictures;  ///< of each entry
  std::string left_out;                  ///< images that were taken for no team's map, joined by ", "

  /// Points count: of victims, or of the judge.
  bool with_points() const;
};

/// The judge's points of teams that are there, no more than 30 a victim; none for an empty `file`. Throws InputError.
std::map<std::string, double> judges_points(const std::string& file, const std::string& folder,
                                            const LeagueTruth& truth, const std::vector<LeagueFiles>& teams);

/// Judges all teams and ranks them; what is wrong with a team's files becomes its note. Pages and pictures of an
/// earlier call in `config.out` are removed first.
League judge_league(const LeagueFolder& folder, const LeagueTruth& truth, const std::map<std::string, double>& judge,
                    const LeagueConfig& config);

/// Writes league.csv and league.html. Throws RunError.
void write_league(const League& league, const LeagueTruth& truth, const std::string& out);

}  // namespace rubble::scoring
