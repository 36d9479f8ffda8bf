#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scenarios/config/scenario.h"

namespace rubble::scenarios {

/// A named set of overrides: one column of an experiment.
struct Configuration {
  std::string name;
  std::string reference;  ///< the configuration it is measured against: the first of `configs`, or the first value of
                          ///< the grid's first key, all else equal; empty when there is nothing to choose from
  std::vector<Override> overrides;
};

/// What a sweep file asks for: every scenario with every configuration and every seed.
struct Sweep {
  std::string name;                           ///< the file's `name`, or its stem
  std::string about;                          ///< for people; stands in reports
  std::string path;                           ///< for messages
  std::vector<std::string> scenarios;         ///< paths that exist
  std::vector<std::uint64_t> seeds;           ///< in the order of the file, no repeats
  std::vector<Configuration> configurations;  ///< named sets x grid; at least one
  double run_limit = 900.0;                   ///< wall time after which a run counts as hanging [s]
};

/// What the runs of one scenario and configuration have in common. It is kept once: a million seeds of it take some
/// 150 MB, where a scenario for each would take gigabytes.
struct JobKind {
  std::string configuration;
  Scenario scenario;  ///< resolved, but for the seed
};

/// One run of a sweep.
struct Job {
  std::string run_id;  ///< 16 hexadecimal digits that name the resolved scenario, the seed and the code
  std::uint64_t seed = 1;
  std::shared_ptr<JobKind> kind = std::make_shared<JobKind>();

  /// With its seed.
  Scenario scenario() const;
  /// Name of the run's folder: readable, and unique by its id.
  std::string folder() const;
};

/// Part `index` (1-based) of `count`.
struct Shard {
  int index = 1;
  int count = 1;
};

/// Reads a sweep file strictly. Scenario paths are relative to it, or bare names of files in `shipped`.
/// Throws InputError.
Sweep load_sweep(const std::string& path, const std::string& shipped = "");

/// Takes the first so many of its seeds (`text` is 6) or others (101-108). Throws std::invalid_argument, what is wrong
/// with `text`.
void choose_seeds(Sweep& sweep, const std::string& text);

/// Every run of the sweep: scenario by scenario, configuration by configuration, seed by seed. `overrides` win over the
/// sweep's own and do not show in the configuration's name. Throws InputError on a scenario that does not load.
std::vector<Job> expand(const Sweep& sweep, const std::string& code, const std::vector<Override>& overrides = {});

/// The jobs of one shard; the id decides, so the shards of a sweep are disjoint and cover it, in any order of the file.
std::vector<Job> in_shard(const std::vector<Job>& jobs, const Shard& shard);

/// What runs of this program depend on beside their scenario: version and commit; of a build with local changes, or
/// without a commit, also the program file itself, so that no result of other code is taken for this one's.
std::string code_version();

}  // namespace rubble::scenarios
