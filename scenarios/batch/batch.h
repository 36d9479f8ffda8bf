#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenarios/batch/merge.h"
#include "scenarios/batch/results.h"
#include "scenarios/batch/sweep.h"
#include "scenarios/run/kept_json.h"

namespace rubble::scenarios {

/// What one run gives, before it becomes a record.
struct RunOutcome {
  KeptJson score;  ///< the content of score.json, times included
  std::string end;
  std::string failure;              ///< not empty: the run failed although it has results
  std::vector<std::string> broken;  ///< expectations that were not met
  std::string hash;                 ///< of the run's artefacts
};

/// Does one run into a folder. Called in worker processes; what it throws makes the run "failed".
using Runner = std::function<RunOutcome(const Job&, const std::string& folder)>;

/// The runner that simulates. `record`: keep each run's log.
Runner simulating_runner(bool record);

/// How far a batch is.
struct BatchProgress {
  std::size_t total = 0;    ///< runs of this shard
  std::size_t skipped = 0;  ///< finished by an earlier call
  std::size_t done = 0;     ///< finished by this call, failures included
  std::size_t failed = 0;   ///< of `done`: failed or timed out
  std::size_t running = 0;
  double elapsed_s = 0.0;
  double remaining_s = 0.0;  ///< expected; 0 until something is known

  std::size_t finished() const { return skipped + done; }
};

/// Picks the moments to tell how far a batch is where each line stays (a file, the log of a CI job): a run has ended
/// and another tenth of them is done, or half a minute is over; ten seconds apart, and not at the end, which has its
/// table.
class ProgressPace {
 public:
  bool due(const BatchProgress& now);

 private:
  std::size_t told_done_ = 0;
  double told_at_ = 0.0;  ///< [s]
};

struct BatchOptions {
  std::string out;  ///< folder for results.jsonl, timing.jsonl, workers.log and runs/
  int workers = 1;
  Shard shard;
  bool retry = false;  ///< make failed and timed-out runs of earlier calls again
  double run_limit = 900.0;
  std::string code;                                 ///< goes into every record
  std::function<bool()> stop;                       ///< true: hand out no more, kill what runs, keep what is finished
  std::function<void(const BatchProgress&)> start;  ///< called once, before the first run
  std::function<void(const BatchProgress&)> progress;
};

struct BatchReport {
  BatchProgress progress;
  bool interrupted = false;
};

/// Makes the runs that the folder does not hold yet. Safe to kill at any time and to call again. Records are the same
/// whatever the number of workers and shards. Throws InputError, RunError (disk full: what is finished is kept).
BatchReport run_batch(const std::vector<Job>& jobs, const Runner& runner, const BatchOptions& options);

/// The results of a batch do not go among the files of a single run or of a scored map. Throws InputError there.
void refuse_run_folder(const std::string& path);

/// Those results in the folder that belong to these jobs: a folder may hold more than one sweep, or several versions.
ResultSet results_of(const std::vector<Job>& jobs, const std::string& folder);

/// The file name suffix of a shard's results: empty for the whole, `-2of4` for a part.
std::string shard_suffix(const Shard& shard);

}  // namespace rubble::scenarios
