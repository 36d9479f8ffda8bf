#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scoring/figures/evidence.h"
#include "scoring/league/league_points.h"
#include "scoring/maps/normalise.h"
#include "scoring/scorecard.h"

namespace rubble::scoring {

/// The victims a map reports.
struct ReportedVictims {
  std::vector<Poi> victims;  ///< in the coordinates of the map's grid
  VictimSource from = VictimSource::None;
  std::size_t symbols = 0;  ///< recognised on the map, also where a list was given
  std::string note;         ///< what to tell people about the list; one line, empty: nothing
};

/// Those of the list, if one is given (not empty), else those drawn on the map. A league list on a map that does not
/// say where the robot started cannot be laid on it: those drawn are taken, and the note says so.
ReportedVictims reported_victims(const LoadedMap& map, const std::string& csv);

/// The victims there are.
struct TrueVictims {
  std::vector<Poi> victims;  ///< in the coordinates of the truth's grid
  std::string path;          ///< of their list; empty: not known
};

/// Those of the list `given`, else of a list beside the truth: TRUTH.csv, X.yaml of X-truth.tif and X-visible.tif,
/// arena.yaml of truth.tif. An arena's list needs a truth that has its coordinates: beside another it is not taken,
/// given for another it throws InputError.
TrueVictims true_victims(const std::string& truth, MapOrigin origin, const std::string& given);

/// Points of what was reported; a map that is not aligned earns none. Nothing where either side is not known.
std::optional<LeaguePoints> victim_points(const OccupancyGrid& map, const OccupancyGrid& truth, const MapScore& score,
                                          const ReportedVictims& reported, const TrueVictims& victims);

/// How many victims of the truth were found.
std::size_t found_victims(const LeaguePoints& points);

/// For the table of figures.
VictimFigures victim_figures(const ReportedVictims& reported, const std::optional<LeaguePoints>& points);

}  // namespace rubble::scoring
