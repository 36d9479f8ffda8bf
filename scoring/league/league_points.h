#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <string>
#include <vector>

#include "base/grid.h"
#include "scoring/maps/pois.h"

namespace rubble::scoring {

/// Section IV.A: of 50 points a victim earns, 10 are for the map around it, 10 for where it lies on the map. The other
/// 30 are the judge's.
struct LeaguePointsConfig {
  double window = 2.4;         ///< side of the part of the map judged around a victim [m]
  double tau = 0.5;            ///< k(d) of the walls in it [m]
  double perfect = 0.1;        ///< errors of location up to here cost nothing [m]
  double worthless = 1.2;      ///< errors from here on earn nothing: one pallet [m]
  double false_report = 10.0;  ///< what each report costs that belongs to no victim: half a victim [points]
  double most_drift = 1.2;     ///< the map around a victim may be off by so much before its walls are compared [m]
};

struct VictimPoints {
  std::string victim;     ///< name in the truth
  std::string report;     ///< name of the report that is it; empty where none is
  bool found = false;     ///< a report of the team lies within `worthless`
  double error_m = 0.0;   ///< of that report, at the one pose of the whole map
  double quality = 0.0;   ///< 0..10: local correctness, the map moved to fit around the victim
  double location = 0.0;  ///< 0..10: global accuracy
};

struct LeaguePoints {
  std::vector<VictimPoints> victims;  ///< those of the truth, in its order
  std::size_t false_alarms = 0;
  double quality = 0.0;  ///< sums
  double location = 0.0;
  double fine = 0.0;  ///< for the false reports, and no more than was earned
  double unfined() const { return quality + location; }
  double points() const { return unfined() - fine; }
};

/// Points of one aligned map. `reported` in the map's coordinates, `victims` in the truth's.
LeaguePoints league_points(const OccupancyGrid& map, const OccupancyGrid& truth, const mrpt::math::TPose2D& T_truth_map,
                           const std::vector<Poi>& reported, const std::vector<Poi>& victims,
                           const LeaguePointsConfig& config = {});

/// 0..1: min(P, R) of the walls in a square around a point of the truth, the map moved a little if that helps. 0 where
/// the truth has no wall.
double local_quality(const OccupancyGrid& map, const OccupancyGrid& truth, const mrpt::math::TPose2D& T_truth_map,
                     const mrpt::math::TPoint2D& p_truth, const LeaguePointsConfig& config = {});

}  // namespace rubble::scoring
