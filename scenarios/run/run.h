#pragma once

#include <mrpt/math/TPose2D.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/config/scenario.h"
#include "scenarios/run/kept_json.h"
#include "scenarios/run/loop.h"
#include "slam/map_base.h"

namespace rubble::scenarios {

struct RunOptions {
  std::string out;                                ///< run folder; empty: runs/<name>-seed<N>-<number>
  bool replace = false;                           ///< an existing run folder may be replaced
  bool record = true;                             ///< keep log.rlog (a simulated run only)
  std::shared_ptr<const slam::MapBase> base;      ///< map_log(): a map to go on with; null: an empty one
  std::string relations;                          ///< map_log(): a file of relations to be judged by; empty: none
  std::optional<mrpt::math::TPose2D> mount;       ///< map_log(): of the laser on the robot, instead of the log's
  bool upside_down = false;                       ///< map_log(): the laser hangs so, whatever the log says
  std::function<void(const std::string&)> note;   ///< map_log(): what of log and relations is doubtful, a line
  bool link_latest = true;                        ///< see RunFolder::link_latest()
  std::function<bool()> interrupted;              ///< asked each tick; true ends the run with its folder complete
  std::function<void(const Progress&)> progress;  ///< called a few times a second
  std::function<void(const explore::Decision&)> decided;  ///< called for each decision of the explorer, in order
  std::function<void(const explore::Decision&)> waits;    ///< called once when the robot waits in vain, see Core::waits
};

struct RunReport {
  std::string folder;
  KeptJson score;     ///< the content of score.json
  std::string end;    ///< why the run ended, for people
  std::string place;  ///< where on the map of an earlier run the robot found itself, for people; empty: no such map
  bool interrupted = false;
  std::string failure;              ///< the robot was lost: the run failed but its folder is complete
  std::vector<std::string> broken;  ///< expectations that were not met, one line each
  /// Victims of the truth that no sensor finds from where the robot can get: by their names, as pictures have them.
  std::vector<std::string> unseen_victims{};
};

/// Simulates, explores, maps and scores one scenario. Throws InputError, RunError.
RunReport run_scenario(const Scenario& scenario, const RunOptions& options);

/// Maps a recorded log (SLAM only). Scores the trajectory when the log carries reference poses. Throws InputError.
RunReport map_log(const std::string& log, const Scenario& scenario, const RunOptions& options);

/// This program's version and what it was built with.
struct Versions {
  std::string rubble;
  std::string commit;  ///< "unknown" outside a checkout; ends in "-dirty" where files differ from it
  std::string compiler;
  std::string build;

  /// As versions.json has it; `indent` < 0: on one line.
  std::string json(int indent) const;
};
Versions versions();

}  // namespace rubble::scenarios
