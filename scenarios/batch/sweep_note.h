#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenarios/batch/merge.h"
#include "scenarios/batch/sweep.h"

namespace rubble::scenarios {

/// What the results of a sweep do not say themselves: kept as sweep.json beside them.
struct SweepNote {
  std::string name;
  std::string about;                              ///< for people
  std::vector<std::string> configurations;        ///< in the order of the sweep file
  std::map<std::string, std::string> references;  ///< which configuration each is measured against
};

/// Keeps beside the results what `sweep` is and which runs its last call, `jobs`, asked for.
void save_note(const Sweep& sweep, const std::vector<Job>& jobs, const std::string& folder);

/// load_results(), of a folder only the runs that the last call of its sweep asked for: a folder may also hold those of
/// older versions of the code, or of other --set values.
ResultSet load_sweep_results(const std::string& path);

/// How many runs the last call of the sweep in `folder` asked for that `runs` lacks, and of how many; {0, 0} where the
/// folder says nothing.
struct MissingRuns {
  std::size_t missing = 0;
  std::size_t asked = 0;
};
MissingRuns missing_runs(const std::string& folder, const std::vector<RunRecord>& runs);

/// The note of the results; when there is none, one made of what the results hold (configurations in their order,
/// measured against the first).
/// Configurations without results are left out, unknown ones come last. Throws InputError.
SweepNote note_of(const ResultSet& set, const std::string& path);

}  // namespace rubble::scenarios
