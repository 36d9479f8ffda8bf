#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/yaml/strict_yaml.h"
#include "scenarios/config/scenario.h"

namespace rubble::scenarios {

/// One of the mappers that are compared.
struct BenchmarkMapper {
  std::string name;
  std::vector<Override> overrides;  ///< mapper.kind and what belongs to it
};

/// What others have published on a case.
struct PublishedFigure {
  std::string by;
  std::string source;  ///< where it is printed
  double value = 0.0;  ///< in the unit of the case's measure
};

/// What a case is judged by, in metres.
enum class BenchmarkMeasure {
  Aligned,   ///< RMS error of the positions after the best rigid alignment with the reference
  Relations  ///< mean error of relations between pairs of moments (Kuemmerle et al. 2009)
};

/// A log or an arena that each mapper is run on.
struct BenchmarkCase {
  std::string name;
  std::string about;
  std::string log;                      ///< path as written in the list, also of a run folder; empty: an arena
  std::string reference;                ///< path as written, TUM text; empty: what is found beside the log, or in it
  std::string relations;                ///< path as written; empty: none
  std::string scenario;                 ///< path as written; empty: a log
  std::vector<std::uint64_t> seeds{1};  ///< of the arena and the run; a log has one
  std::vector<Override> overrides;      ///< of the scenario, for this case
  BenchmarkMeasure measure = BenchmarkMeasure::Aligned;
  std::optional<double> goal;              ///< of the measure, at most; of several seeds for the median [m]
  std::optional<double> heading_goal;      ///< of the heading of relations [deg]
  std::optional<double> live_goal;         ///< the same of the poses as known at each scan [m]
  std::optional<double> worst_goal;        ///< of the worst of several seeds [m]
  std::optional<double> false_loops_goal;  ///< closed loops that lead to another place, of all seeds together
  std::optional<double> speed_goal;        ///< scans a second of CPU time, at least
  std::optional<double> slow_goal;         ///< what 99 of 100 scans stay below [ms]
  std::optional<double> worst_time_goal;   ///< of any scan [ms]
  std::vector<PublishedFigure> published;
};

struct BenchmarkList {
  std::string name;
  std::string about;
  std::string path;              ///< for messages
  std::string folder;            ///< of the file: paths are relative to it
  std::optional<int> cpu_limit;  ///< of one mapper on one case and seed: then it is stopped [s]
  std::vector<BenchmarkMapper> mappers;
  std::vector<BenchmarkCase> cases;
};

/// Reads a list strictly. Whether its logs exist is not asked. Throws InputError.
BenchmarkList load_benchmark(const std::string& path);

/// Where a file of the list lies: as it is when absolute, else below one of `folders` (the first that has it). Empty
/// when it is nowhere.
std::string find_in(const std::vector<std::string>& folders, const std::string& path);

}  // namespace rubble::scenarios
