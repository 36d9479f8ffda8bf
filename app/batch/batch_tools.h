#pragma once

#include <string>
#include <vector>

#include "app/command.h"
#include "scenarios/batch/batch.h"

namespace rubble::app {

/// Declares --workers.
void add_workers(Options& options, int& workers);

/// Says when runs that the sweep in `folder` asked for are not there (a shard that failed or still works); true: all
/// are.
bool tell_missing(const std::string& folder, const std::vector<scenarios::RunRecord>& runs);

/// The page of the sweep whose results lie in `source`. Throws InputError, RunError.
void write_report(const std::string& source, const std::string& page);

/// Cores this process may run on: fewer than the machine's in a container or under a scheduler.
int usable_cores();

/// Makes the runs and tells how far they are; Ctrl-C stops it with everything finished kept.
scenarios::BatchReport run_with_progress(const std::vector<scenarios::Job>& jobs, scenarios::BatchOptions options,
                                         bool record);

}  // namespace rubble::app
