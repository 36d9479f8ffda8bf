#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenarios/run/run.h"

namespace rubble::scenarios {

/// One artefact of a re-run beside the recorded one.
struct ReplayedArtefact {
  std::string name;
  bool same = false;
};

/// In versions.json: the motion was not the explorer's (an operator's, or a calibration's).
constexpr const char* kSteeredByHand = "steered_by_hand";

struct ReplayReport {
  std::vector<ReplayedArtefact> artefacts;
  bool identical = false;
  bool ended = true;                   ///< the recorded run ended; else only the trajectory so far can be compared
  std::size_t different_commands = 0;  ///< ticks in which the core commanded something else than recorded
  std::size_t ticks = 0;
};

/// Runs mapper, levelling and explorer again on a recorded run and compares trajectory, map and commands bit by bit.
ReplayReport replay_run(const std::string& folder, const RunOptions& options);
/// The same with a scenario other than the recorded one. `film`: so many moments of the run, drawn into film.png beside
/// the other artefacts; 0: none.
ReplayReport replay_run(const std::string& folder, const Scenario& scenario, const RunOptions& options, int film = 0);
/// The scenario of a recorded run. Throws InputError for a folder that is none.
Scenario recorded_scenario(const std::string& folder, const std::vector<Override>& overrides = {});

}  // namespace rubble::scenarios
