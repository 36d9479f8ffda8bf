#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/command.h"
#include "app/mapper_choice.h"
#include "scenarios/config/scenario.h"

namespace rubble::app {

/// Declares `--set key.key=value`, any number of times.
void add_sets(Options& options, std::vector<std::string>& sets);

/// The values given with --set. Throws UsageError for another form.
std::vector<scenarios::Override> parse_sets(const std::vector<std::string>& sets);

/// The same for all runs of a sweep, which brings names and seeds itself. Throws UsageError for these.
std::vector<scenarios::Override> parse_sweep_sets(const std::vector<std::string>& sets);

/// What the commands that make a run folder share.
struct RunFolderOptions {
  std::string out;
  bool force = false;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> sets;
  MapperChoice mapper;

  /// Declares all but the seed, which each command explains in its own words.
  void declare(Options& options);
  /// The mapper's command, what --set says, then the seed.
  std::vector<scenarios::Override> overrides() const;
};

/// A log file, or the log inside a run folder.
std::string recorded_log(const std::string& path);

/// Where `scenarios` and `robots` that ship with rubble lie.
std::string shipped_folder(const std::string& kind = "scenarios");

/// A path, or the bare name of a scenario that ships with rubble; no name: the main job.
std::string find_scenario(const std::string& name);

/// A path, or the bare name of a robot file that ships with rubble; no name: the Pioneer with its URG.
std::string find_robot(const std::string& name);

/// A path, or the bare name of a list of `rubble benchmark` that ships with rubble; no name: that of public logs.
std::string find_list(const std::string& name);

/// A path, or the bare name of a sweep that ships with rubble.
std::string find_sweep(const std::string& name);

}  // namespace rubble::app
