#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scoring/league/league_points.h"
#include "scoring/maps/normalise.h"
#include "scoring/scorecard.h"

namespace rubble::app {

/// The victims a map reports.
struct ReportedVictims {
  std::vector<scoring::Poi> victims;  ///< in the coordinates of the map's grid
  std::string from = "none";          ///< "csv", "symbols" (drawn on the map) or "none"
  std::size_t symbols = 0;            ///< recognised on the map, also where a list was given
};

/// Those of the list, if one is given (not empty), else those drawn on the map. A league list on a map that does not
/// say where the robot started cannot be laid on it: those drawn are taken, and a line on stderr says so.
ReportedVictims reported_victims(const scoring::LoadedMap& map, const std::string& csv);

/// The victims there are.
struct TrueVictims {
  std::vector<scoring::Poi> victims;  ///< in the coordinates of the truth's grid
  std::string path;                   ///< of their list; empty: not known
};

/// Those of the list `given`, else of a list beside the truth: TRUTH.csv, X.yaml of X-truth.tif and X-visible.tif,
/// arena.yaml of truth.tif. An arena's list needs a truth that has its coordinates: beside another it is not taken,
/// given for another it throws InputError.
TrueVictims true_victims(const std::string& truth, scoring::MapOrigin origin, const std::string& given);

/// Points of what was reported; a map that is not aligned earns none. Nothing where either side is not known.
std::optional<scoring::LeaguePoints> victim_points(const OccupancyGrid& map, const OccupancyGrid& truth,
                                                   const scoring::MapScore& score, const ReportedVictims& reported,
                                                   const TrueVictims& victims);

/// How many victims of the truth were found.
std::size_t found_victims(const scoring::LeaguePoints& points);

/// The victims of a single map: the row of the table and the keys of score.json.
void print_victims(const ReportedVictims& reported, const std::optional<scoring::LeaguePoints>& points);
void add_victims(nlohmann::ordered_json& json, const ReportedVictims& reported,
                 const std::optional<scoring::LeaguePoints>& points);

}  // namespace rubble::app
