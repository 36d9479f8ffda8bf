#pragma once

#include <string>
#include <vector>

#include "scenarios/batch/results.h"

namespace rubble::scenarios {

/// Results of one or many batches, from wherever they were kept.
struct ResultSet {
  std::vector<RunRecord> runs;  ///< one a run, sorted by scenario, configuration, seed
  Timing timing;
  std::string folder;  ///< run folders are relative to this
};

/// Reads the folder of a batch, one results*.jsonl, or a file of merge(). Throws InputError.
ResultSet load_results(const std::string& path);

struct MergeReport {
  std::size_t runs = 0;   ///< now in the file
  std::size_t added = 0;  ///< of them new
};

/// Merges result folders and files into one SQLite file; what it already holds stays. The same results give the same
/// bytes, however often and in whatever order they are merged (but for the table of times).
///   runs(run_id, scenario, config, seed, status, error, end, broken, score, hash, folder, code)
///   metrics(run_id, key, value): a view of the numbers in `score`     timing(run_id, key, value)
/// Throws InputError (not readable, two different results of one run), RunError (cannot be written).
MergeReport merge(const std::vector<std::string>& sources, const std::string& out);

}  // namespace rubble::scenarios
