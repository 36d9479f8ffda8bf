#pragma once

#include <string>
#include <vector>

#include "scenarios/batch/batch.h"

namespace rubble::app {

/// Where the shipped scenarios lie.
std::string shipped_folder();

/// A path, or the bare name of a sweep that ships with rubble.
std::string find_sweep(const std::string& name);

/// Cores this process may run on: fewer than the machine's in a container or under a scheduler.
int usable_cores();

/// Makes the runs with progress on a terminal; Ctrl-C stops it with everything finished kept.
scenarios::BatchReport run_with_progress(const std::vector<scenarios::Job>& jobs, scenarios::BatchOptions options,
                                         bool record);

}  // namespace rubble::app
