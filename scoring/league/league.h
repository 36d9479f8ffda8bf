#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scoring/figures/figures.h"
#include "scoring/league/league_victims.h"
#include "scoring/scorecard.h"

namespace rubble::scoring {

/// One team's map in a league.
struct LeagueEntry {
  std::string team;
  std::string file;
  std::string error;  ///< why it cannot be judged; empty: it was
  MapScore score;
  ReportedVictims reported;
  std::optional<LeaguePoints> points;  ///< of victims the team reported
  double judge = 0.0;                  ///< the judge's points
  int rank = 0;                        ///< from 1; equal figures share the better one; 0: could not be judged
  std::string rank_text() const;       ///< "-" without one
  std::string note() const { return error.empty() ? score.note : error; }
  /// What the table of figures reads.
  Evidence evidence() const;
  /// As people read it: empty where only the map's place would tell, and nobody knows that.
  std::string text_of(const Figure& figure, const Evidence& of_this) const;
  double total() const { return judge + (points ? points->points() : 0.0); }
};

/// Sorts and numbers the entries. Those that could be judged come first: the higher score (to 0.001) wins, then
/// more points (to 0.1). Entries equal in both share a rank and stand in the order of their names; the next rank is as
/// many higher (1, 2, 2, 4). Entries that could not be judged come last, without a rank. Neither names nor the order of
/// `entries` decide anything else.
void rank_league(std::vector<LeagueEntry>& entries);

/// The ranking as CSV with a header: rank, team, points, judge, the figures that the table has for it, file, note.
/// Rank and figures of unjudged entries are empty.
std::string league_csv(const std::vector<LeagueEntry>& entries);

inline constexpr double kJudgesMostPerVictim = 30.0;  ///< points

/// Reads the judge's points: CSV with the header `team,points` or `team,victim,points`; 0 to 30 a victim, rows of one
/// team added up. Throws InputError with file and line, also where a victim stands twice for one team.
std::map<std::string, double> read_judge(const std::string& path);

}  // namespace rubble::scoring
