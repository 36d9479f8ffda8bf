#pragma once

#include <string>
#include <vector>

namespace rubble::scoring {

/// One team's files in the folder of a league.
struct LeagueFiles {
  std::string team;
  std::string map;   ///< empty: none was found, see `error`
  std::string pois;  ///< empty: none
  std::string error;
};

/// The folder of a league.
struct LeagueFolder {
  std::vector<LeagueFiles> teams;    ///< sorted by name
  std::vector<std::string> skipped;  ///< images in it that are no team's map, relative to it, sorted
};

/// A team is a map file in `folder` (its name without the ending, victims in NAME.csv or NAME_pois.csv) or a folder in
/// it (map.tif and the like, victims in pois.csv or map.csv). Of a map in several formats tif counts, then yaml, png,
/// jpg, pgm. No team's maps are the truth (the file itself in any format, or a copy of it under its name) and what
/// runs, scorings and arena files leave: truth, overlay, NAME.png beside NAME-truth.tif; NAME-truth, NAME-visible,
/// NAME-overlay, NAME-error, NAME-sight beside an image NAME; error, sight, arena beside an image `map`; all of these
/// beside score.json or league.csv. Throws InputError: no folder, no team in it.
LeagueFolder find_league(const std::string& folder, const std::string& truth);

/// The files hold the same bytes.
bool same_content(const std::string& a, const std::string& b);

}  // namespace rubble::scoring
