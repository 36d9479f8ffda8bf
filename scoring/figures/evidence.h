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
#include "scoring/trajectory/relative_error.h"
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
  double error_m = 0.0;                                  ///< mean over those found [m]
  double quality = 0.0;                                  ///< points for the map around them
  double location = 0.0;                                 ///< points for where they lie
  double fine = 0.0;                                     ///< points that the false reports cost
  double unfined() const { return quality + location; }  ///< as the league counts them
  double points() const { return unfined() - fine; }
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

/// What the truth says about a drive. All of it follows from the arena and the true poses; the core knows nothing of
/// it.
struct DriveFigures {
  double way_m = 0.0;            ///< driven in the plan view
  double contact_s = 0.0;        ///< time within 12 mm of a solid or of a step too high to climb
  std::uint64_t contacts = 0;    ///< spells of it
  double contact_speed = 0.0;    ///< the fastest at which one began [m/s]
  double min_clearance_m = 0.0;  ///< of the outline, to the nearest such thing (0.5 m when never nearer)
  double home_m = 0.0;           ///< from the start at the end
};

/// How the mission of a simulated run went.
struct MissionFigures {
  std::string end_code;  ///< "explored", "home", "time", "stuck", "lost", "fell" or "interrupted"
  DriveFigures drive;
  std::uint64_t stalls = 0;                 ///< reported by the motors
  double area_per_min = 0.0;                ///< of floor, until 95 % of all that its laser can see were known [m^2/min]
  std::uint64_t victims_withdrawn = 0;      ///< that it was sure of and later no more
  std::uint64_t victims_visible = 0;        ///< that a sensor could find from where the robot can get
  std::vector<std::string> unseen_victims;  ///< the names of the others, as the arena has them
  double visible_share = 0.0;               ///< of the truth's floor, what its laser can see from where it can get
  std::uint64_t rooms_reachable = 0;        ///< whose floor the robot's middle can get to
  std::uint64_t rooms_entered = 0;          ///< of these
};

/// What a real robot's devices did.
struct DeviceFigures {
  std::uint64_t bad_packets = 0;  ///< of the base
  std::uint64_t odometry_jumps = 0;
  std::uint64_t scans_damaged = 0;
  std::uint64_t scans_missed = 0;
  double answer_ms_median = 0.0;  ///< from a scan's arrival until its answer goes to the base's line [ms]
  double answer_ms_99 = 0.0;      ///< 99 % are below [ms]
  double cpu_share = 0.0;         ///< of one core, from start to end
};

/// How two trajectories differ piece by piece.
struct PieceErrors {
  RelativeError frames;  ///< between consecutive poses of the estimate
  RelativeError metres;  ///< over a metre of path each
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
  std::optional<MissionFigures> mission;
  std::optional<DeviceFigures> devices;
  std::optional<PieceErrors> pieces;       ///< of `estimate`
  std::optional<RelationError> relations;  ///< of `estimate`, to relations that are known
  std::optional<MachineFigures> machine;
};

}  // namespace rubble::scoring
