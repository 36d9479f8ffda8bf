#pragma once

#include <string>
#include <vector>

namespace rubble::app {

/// One team's files in the folder of a league.
struct LeagueFiles {
  std::string team;
  std::string map;   ///< empty: none was found, see `error`
  std::string pois;  ///< empty: none
  std::string error;
};

/// A team is a map file in `folder` (its name without the ending, victims in NAME.csv or NAME_pois.csv) or a folder in
/// it (map.tif and the like, victims in pois.csv or map.csv). Of a map in several formats tif counts, then yaml, png,
/// jpg, pgm. Sorted by name. Throws InputError: no folder, nothing in it.
std::vector<LeagueFiles> find_league(const std::string& folder);

}  // namespace rubble::app
