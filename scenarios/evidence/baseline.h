#pragma once

#include <string>
#include <vector>

#include "scenarios/batch/merge.h"
#include "scenarios/evidence/metrics.h"

namespace rubble::scenarios {

struct BaselineMetric {
  std::string key;
  double median = 0.0;     ///< over the seeds
  double tolerance = 0.0;  ///< a median worse by more than this is a regression
  double mean = 0.0;       ///< over the seeds: a few ruined runs move it, though not the median
  double mean_tolerance = 0.0;
  std::size_t missing = 0;  ///< runs without the number: more of them are a regression
};

/// How one scenario with one configuration did.
struct BaselineGroup {
  std::string scenario;
  std::string configuration;
  std::vector<std::uint64_t> seeds;
  std::size_t failed = 0;  ///< runs that did not end well
  std::vector<BaselineMetric> metrics;
};

struct Baseline {
  std::string sweep;
  std::string code;
  int score_version = 1;  ///< of the scores in it; files that do not say are of version 1
  std::vector<BaselineGroup> groups;
};

/// Medians and means over seeds of every judged metric. The tolerance of the median is twice its standard error (1.2533
/// sigma / sqrt n, sigma from the median absolute deviation), that of the mean three times its standard error, each at
/// least the metric's floor; that of the mean also covers one run that loses one (a victim). An unchanged program gives
/// the same numbers to the bit, so the tolerances only have to cover changes that are neutral but move every run a
/// little.
Baseline make_baseline(const std::string& sweep, const std::vector<RunRecord>& runs);

/// A JSON file, made to be read, edited and kept under version control. Throws RunError.
void save_baseline(const Baseline& baseline, const std::string& path);
/// Throws InputError.
Baseline load_baseline(const std::string& path);

/// One thing that was checked.
struct CheckCase {
  std::string group;  ///< scenario / configuration
  std::string name;   ///< metric, "runs completed" or "expectations"
  bool passed = true;
  std::string detail;  ///< what was found and what was wanted
};

/// Throws InputError when the baseline is about other scenarios, configurations, seeds, another version of the score or
/// other metrics. `runs` need not be made yet: without scores they count as judged by this program.
void require_fit(const Baseline& baseline, const std::vector<RunRecord>& runs);

/// Judges runs against a baseline, and each run against the expectations of its scenario. Only worse medians fail,
/// better ones pass. Throws what require_fit() throws.
std::vector<CheckCase> check_runs(const Baseline& baseline, const std::vector<RunRecord>& runs);

std::size_t failures(const std::vector<CheckCase>& cases);

/// JUnit XML as CI systems read it: one suite a group, one case a metric.
std::string to_junit(const std::vector<CheckCase>& cases, const std::string& suite);
/// One `::error` workflow command a failure, as GitHub Actions reads them from the log.
std::string to_github_annotations(const std::vector<CheckCase>& cases);
/// A table for a job summary.
std::string to_markdown(const std::vector<CheckCase>& cases, const std::string& title);

}  // namespace rubble::scenarios
