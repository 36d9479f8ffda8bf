#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenarios/config/scenario.h"
#include "scenarios/run/loop.h"

namespace rubble::scenarios {

struct RunOptions {
  std::string out;                                ///< run folder; empty: runs/<name>-seed<N>-<number>
  bool replace = false;                           ///< an existing run folder may be replaced
  bool record = true;                             ///< keep log.rlog (a simulated run only)
  bool link_latest = true;                        ///< let `latest` beside the folder point to it
  std::function<bool()> interrupted;              ///< asked each tick; true ends the run with its folder complete
  std::function<void(const Progress&)> progress;  ///< called a few times a second
  std::function<void(const explore::Decision&)> decided;  ///< called for each decision of the explorer, in order
};

struct RunReport {
  std::string folder;
  nlohmann::ordered_json score;  ///< the content of score.json
  std::string end;               ///< why the run ended, for people
  bool interrupted = false;
  std::string failure;              ///< the robot was lost: the run failed but its folder is complete
  std::vector<std::string> broken;  ///< expectations that were not met, one line each
};

/// Simulates, explores, maps and scores one scenario. Throws InputError, RunError.
RunReport run_scenario(const Scenario& scenario, const RunOptions& options);

/// Maps a recorded log (SLAM only). Scores the trajectory when the log carries reference poses. Throws InputError.
RunReport map_log(const std::string& log, const Scenario& scenario, const RunOptions& options);

/// This program's version and what it was built with, for versions.json.
nlohmann::ordered_json versions();

}  // namespace rubble::scenarios
