#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenarios/config/scenario.h"

namespace rubble::scenarios {

/// How far a run is, for a progress line.
struct Progress {
  double sim_s = 0.0;     ///< time covered so far [s]
  double share = 0.0;     ///< of the time limit or of the log, 0..1
  double known_m2 = 0.0;  ///< area mapped so far [m^2]
  double real_time_factor = 0.0;
};

struct RunOptions {
  std::string out;                                ///< run folder; empty: runs/<name>-seed<N>-<number>
  bool replace = false;                           ///< an existing run folder may be replaced
  bool record = true;                             ///< keep log.rlog (a simulated run only)
  bool link_latest = true;                        ///< let `latest` beside the folder point to it
  std::function<bool()> interrupted;              ///< asked each tick; true ends the run with its folder complete
  std::function<void(const Progress&)> progress;  ///< called a few times a second
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

/// One artefact of a re-run beside the recorded one.
struct ReplayedArtefact {
  std::string name;
  bool same = false;
};

struct ReplayReport {
  std::vector<ReplayedArtefact> artefacts;
  bool identical = false;
  bool ended = true;                   ///< the recorded run ended; else only the trajectory so far can be compared
  std::size_t different_commands = 0;  ///< ticks in which the core commanded something else than recorded
  std::size_t ticks = 0;
};

/// Runs mapper, levelling and explorer again on a recorded run and compares trajectory, map and commands bit by bit.
ReplayReport replay_run(const std::string& folder, const RunOptions& options);
/// The same with a scenario other than the recorded one.
ReplayReport replay_run(const std::string& folder, const Scenario& scenario, const RunOptions& options);
/// The scenario of a recorded run. Throws InputError for a folder that is none.
Scenario recorded_scenario(const std::string& folder, const std::vector<Override>& overrides = {});

/// The keys of score.json that depend on the machine, not on the seed.
bool is_timing_key(const std::string& key);

/// This program's version and what it was built with, for versions.json.
nlohmann::ordered_json versions();

}  // namespace rubble::scenarios
