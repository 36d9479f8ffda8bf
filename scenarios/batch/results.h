#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scenarios/run/kept_json.h"

namespace rubble::scenarios {

/// How a run of a batch ended: with a result, without one, or killed because it took too long.
enum class RunStatus { Ok, Failed, TimedOut };

/// "ok", "failed" or "timeout", as files call them.
std::string name_of(RunStatus status);
/// Throws InputError for another name.
RunStatus status_named(const std::string& name);

/// What is kept of one run: only what depends on scenario, seed and code. Times are kept apart (see Timing).
struct RunRecord {
  std::string run_id;
  std::string scenario;
  std::string configuration;
  std::uint64_t seed = 0;
  RunStatus status = RunStatus::Failed;
  std::string error;                ///< why it is not ok
  std::string end;                  ///< why the run ended, for people
  std::vector<std::string> broken;  ///< expectations that were not met
  KeptJson score;                   ///< the numbers of score.json that do not depend on the machine
  std::string hash;                 ///< of every artefact of the run together; empty: not known
  std::string folder;               ///< of the run, relative to the folder of the results
  std::string code;                 ///< code_version() of the program that made it

  bool ok() const { return status == RunStatus::Ok; }
  /// A number of the score; booleans are 0 and 1; NaN where there is none. `completed` is 1 for ok, else 0.
  double metric(const std::string& key) const;
};

/// metric(key) of those runs that have it.
std::vector<double> numbers(const std::vector<const RunRecord*>& runs, const std::string& key);

/// Numbers of one run that depend on the machine (wall_s, real_time_factor, peak_mb), by run_id.
using Timing = std::map<std::string, KeptJson>;

/// One line of JSON without its end.
std::string to_line(const RunRecord& record);
/// `place` (file:line) begins the InputError of a line that is no record.
RunRecord from_line(const std::string& line, const std::string& place);

/// A results file that is being written: held by one process, every line on disk before the next run is handed out.
class ResultsFile {
 public:
  /// Opens DIR/results`suffix`.jsonl, drops a torn last line. Throws InputError (another process writes it, a line
  /// before the last is no record), RunError.
  ResultsFile(const std::string& folder, const std::string& suffix);
  ~ResultsFile();
  ResultsFile(const ResultsFile&) = delete;
  ResultsFile& operator=(const ResultsFile&) = delete;

  /// What the file held when it was opened.
  const std::vector<RunRecord>& records() const { return records_; }
  /// Appends one record and its times and waits until they are on disk. Throws RunError with the file as it was before.
  void append(const RunRecord& record, const nlohmann::ordered_json& timing);

 private:
  std::string path_, timing_path_;
  int file_ = -1, timing_file_ = -1;
  std::vector<RunRecord> records_;
};

/// One record a run: of several with one id the ok one stands, else the last. Sorted by scenario, configuration, seed.
/// Throws InputError when two ok records of one id differ: then the program is not deterministic.
std::vector<RunRecord> unique_runs(std::vector<RunRecord> records, const std::string& source);

/// Reads every results*.jsonl of a folder, or one such file; a torn last line is left out. Throws InputError.
std::vector<RunRecord> load_lines(const std::string& path);
/// Reads every timing*.jsonl of the folder of `path`; what is not there or torn is left out.
Timing load_timing(const std::string& path);

}  // namespace rubble::scenarios
