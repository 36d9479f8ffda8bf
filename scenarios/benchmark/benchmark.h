#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/benchmark/benchmark_list.h"

namespace rubble::scenarios {

/// What one mapper made of one case.
struct BenchmarkResult {
  std::string mapper;
  std::string missing;                 ///< a file that is not there: nothing was run; says which
  std::string failure;                 ///< the mapper was lost or the input refused; says why
  bool stopped = false;                ///< the failure is that it took longer than the list lets a mapper take
  std::size_t runs = 0;                ///< one for each seed; where there are several, errors are medians
  std::optional<double> error_m;       ///< the case's measure, of the final trajectory [m]
  std::optional<double> worst_m;       ///< the same of the worst of several runs [m]
  std::optional<double> live_error_m;  ///< the same of the poses as known at each scan [m]
  std::optional<double> error_deg;     ///< of relations [deg]
  std::uint64_t scans = 0;
  // Of a program whose processes cannot be seen, times and memory are not known.
  std::optional<double> scans_per_second;  ///< CPU time of update(), all in all
  std::optional<double> usual_ms;          ///< of a scan, its share of the update that placed it: the median,
  std::optional<double> slow_ms;           ///< what 99 of 100 stay below,
  std::optional<double> worst_ms;          ///< and the worst [ms]; of several runs the largest of each
  /// The most work of a scan, in millions of units that the mapper counts; of several runs the largest.
  std::optional<double> most_work_ms;
  std::optional<double> finish_ms;  ///< after the last scan [ms]
  std::optional<double> peak_mb;
  std::optional<double> loops_closed;
  std::optional<double> loops_removed;
  std::optional<double> loops_false;      ///< that hold and the truth contradicts (scoring::false_relations)
  std::optional<double> doubted;          ///< runs whose map the mapper itself does not believe
  std::optional<bool> goal_met;           ///< all of the case's; nothing: it has none, or nothing was measured
  std::vector<std::string> goals_missed;  ///< columns whose goal is not
  std::string doubt;                      ///< of the error, for people: what it was judged by may be of another log
  std::string not_judged;                 ///< why the error is not known, where the case has a goal of it; empty: it is
};

struct BenchmarkRow {
  BenchmarkCase what;
  std::vector<BenchmarkResult> results;  ///< in the order of the list's mappers
};

/// What an interruption has kept from being run.
struct BenchmarkGap {
  std::string name;  ///< of the case
  std::string mapper;
  std::size_t runs = 0;   ///< seeds that were done before it; their figures stand in the case's row
  std::size_t seeds = 1;  ///< that were asked for
};

struct Benchmark {
  std::string name;
  std::string about;
  std::vector<BenchmarkRow> rows;  ///< only those with a result
  std::vector<BenchmarkGap> gaps;  ///< empty: it was not interrupted
};

/// How far a benchmark is.
struct BenchmarkProgress {
  std::size_t number = 0;  ///< of the case, from 1
  std::size_t cases = 0;
  std::string name;  ///< of the case
  std::string mapper;
  std::size_t seed = 0;  ///< the how manieth of them, from 1
  std::size_t seeds = 1;
  std::optional<double> share;                ///< of a log, 0..1
  const BenchmarkResult* finished = nullptr;  ///< the mapper is through with the case
};

struct BenchmarkOptions {
  std::vector<std::string> folders;  ///< where logs are looked for, beside the list's own
  std::function<void(const BenchmarkProgress&)> progress;
  std::function<bool()> interrupted;      ///< true: what runs is ended, and no more is run
  std::function<void(Scenario&)> permit;  ///< asked before a mapper that is a program of the user's
};

/// Runs each mapper on each case, each in a process of its own, one after the other: memory and time are then its own.
/// Throws InputError for parameters that no mapper has, RunError when a process cannot be made.
Benchmark run_benchmark(const BenchmarkList& list, const BenchmarkOptions& options);

}  // namespace rubble::scenarios
