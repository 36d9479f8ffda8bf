#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/batch/merge.h"
#include "scenarios/evidence/metrics.h"
#include "scenarios/evidence/statistics.h"

namespace rubble::scenarios {

/// What the evidence says about B against A.
enum class Verdict { Identical, NoEvidence, Better, Worse, Higher, Lower };
const char* text_of(Verdict verdict);

/// One metric over all pairs of one group. The unit of evidence is a scenario and seed: differences of several
/// configurations on the same arena are averaged first, for they are not independent.
struct MetricComparison {
  Metric metric;
  std::size_t pairs = 0;    ///< scenarios x seeds in which both have the number
  std::size_t missing = 0;  ///< in which only one has it, or neither
  double mean_a = 0.0;
  double mean_b = 0.0;
  double difference = 0.0;  ///< mean of B - A
  Interval interval;        ///< of the difference, 95 %
  std::size_t better = 0;   ///< pairs in which B is better (or higher, when neither is better)
  std::size_t worse = 0;
  double p_sign = 1.0;
  Verdict verdict = Verdict::NoEvidence;
};

struct ComparisonGroup {
  std::string name;  ///< a configuration, or "all"
  std::vector<MetricComparison> metrics;
};

struct Comparison {
  std::string a, b;  ///< what was compared
  std::size_t pairs = 0;
  std::size_t only_a = 0, only_b = 0;  ///< runs without a partner
  std::vector<ComparisonGroup> groups;
};

struct CompareOptions {
  std::string configuration_a, configuration_b;  ///< given: only these, paired with each other
  bool by_configuration = false;                 ///< also a group for each configuration
  bool all_metrics = false;                      ///< also the metrics of which neither direction is better
  std::uint64_t seed = 1;                        ///< of the bootstrap
};

/// Pairs runs by scenario, configuration and seed. B is called better or worse only when the 95 % interval of the mean
/// difference leaves out zero AND the exact sign test gives p <= 0.05. Throws InputError when nothing pairs.
Comparison compare(const ResultSet& a, const ResultSet& b, const std::string& name_a, const std::string& name_b,
                   const CompareOptions& options = {});

}  // namespace rubble::scenarios
