#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/grid.h"
#include "base/trajectory.h"
#include "scoring/scorecard.h"
#include "scoring/trajectory/trajectory_error.h"

namespace rubble::scoring {

/// Where the victims that a map reports were found.
enum class VictimSource { None, List, Symbols };

/// "none", "csv" or "symbols": as files and tables call them.
std::string name_of(VictimSource source);

/// The victims a map reports, and what they are worth.
struct VictimFigures {
  VictimSource from = VictimSource::None;
  std::size_t symbols = 0;  ///< recognised on the map, also where a list was given
  std::size_t reported = 0;
  bool judged = false;    ///< the true victims are known; else the fields below say nothing
  std::size_t total = 0;  ///< victims there are
  std::size_t found = 0;
  std::size_t false_alarms = 0;
  double error_m = 0.0;   ///< mean over those found [m]
  double quality = 0.0;   ///< points for the map around them
  double location = 0.0;  ///< points for where they lie
};

/// What a mapper and an explorer did in one run.
struct RunFigures {
  std::string end;             ///< why the run ended, for people
  double sim_s = 0.0;          ///< time covered [s]
  double area_known_m2 = 0.0;  ///< of the map
  std::uint64_t scans = 0;
  std::uint64_t scans_mapped = 0;
  std::uint64_t scans_out_of_order = 0;
  std::uint64_t hits_outside = 0;                   ///< laser hits beyond the largest map
  std::vector<std::pair<std::string, double>> own;  ///< of this kind of mapper alone; kept behind the table's figures
};

/// What depends on the machine, not on the seed.
struct MachineFigures {
  double wall_s = 0.0;  ///< time taken from start to score [s]
  double peak_mb = 0.0;
};

/// All that is known about one run or one map when it is judged; what the table's figures are taken from. A part that
/// is empty or null makes its figures unknown: a log without truth, a judge's map without a run.
struct Evidence {
  std::optional<MapScore> score;
  const OccupancyGrid* map = nullptr;  ///< as it was read back from its file
  const OccupancyGrid* truth = nullptr;
  std::string map_read_as;  ///< what the file was recognised as
  std::string truth_read_as;
  const Trajectory* estimate = nullptr;       ///< T_map_base as known in the end
  const Trajectory* live_estimate = nullptr;  ///< as known at each scan
  const Trajectory* true_path = nullptr;
  std::optional<TrajectoryError> error;       ///< of `estimate`
  std::optional<TrajectoryError> live_error;  ///< of `live_estimate`
  std::optional<VictimFigures> victims;
  std::optional<RunFigures> run;
  std::optional<MachineFigures> machine;
};

}  // namespace rubble::scoring
