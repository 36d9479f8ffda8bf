#pragma once

#include <string>
#include <vector>

#include "scenarios/config/scenario.h"

namespace rubble::scenarios {

/// A sweep as one Slurm array job, a shard a task, and a job that merges when all tasks have ended.
struct SlurmPlan {
  std::string name;
  std::string sweep;    ///< path of the sweep file
  std::string out;      ///< on a file system that all nodes see
  std::string program;  ///< this program, as the nodes find it
  std::string home;     ///< RUBBLE_HOME for the nodes; empty: unset
  int shards = 8;
  int workers = 1;  ///< cores of a task
  bool record = false;
  bool allow_commands = false;  ///< of mappers, when the user allowed them
  bool retry = false;
  std::vector<Override> overrides;
  std::vector<std::string> options;  ///< for sbatch, of the array job: "--partition=x", "--time=2:00:00"
};

struct SlurmScripts {
  std::string array;
  std::string merge;
};

/// The two batch scripts; they can also be submitted by hand, array first.
SlurmScripts slurm_scripts(const SlurmPlan& plan);

/// Writes OUT/slurm/array.sh and merge.sh and returns their paths. Throws InputError, RunError.
SlurmScripts write_slurm(const SlurmPlan& plan);

struct SlurmJobs {
  std::string array;
  std::string merge;
};

/// Submits both, the merge depending on the end of the array job, however it ends. Throws RunError with what sbatch
/// said.
SlurmJobs submit_slurm(const SlurmScripts& paths);

/// One word for the shell.
std::string shell_word(const std::string& text);

}  // namespace rubble::scenarios
