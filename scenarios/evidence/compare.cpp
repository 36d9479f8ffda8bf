#include "scenarios/evidence/compare.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "base/error.h"
#include "scenarios/batch/score_version.h"

namespace rubble::scenarios {
namespace {

struct Pair {
  const RunRecord* a = nullptr;
  const RunRecord* b = nullptr;
};

using Key = std::tuple<std::string, std::string, std::uint64_t>;  // scenario, configuration, seed

std::set<std::string> configurations(const std::vector<RunRecord>& runs) {
  std::set<std::string> names;
  for (const auto& run : runs) names.insert(run.configuration);
  return names;
}

std::map<Key, const RunRecord*> by_key(const ResultSet& set, const std::string& name,
                                       const std::string& configuration) {
  std::map<Key, const RunRecord*> runs;
  for (const auto& run : set.runs) {
    if (!configuration.empty() && run.configuration != configuration) continue;
    const Key key{run.scenario, configuration.empty() ? run.configuration : "", run.seed};
    if (!runs.emplace(key, &run).second)
      throw InputError(name +
                       ": holds several results for one scenario, configuration and seed, from several versions of "
                       "the code or calls with other --set values; compare folders that one command wrote");
  }
  if (runs.empty()) {
    std::string known;
    for (const auto& c : configurations(set.runs)) known += (known.empty() ? "'" : ", '") + c + "'";
    throw InputError(name + ": holds no runs" +
                     (configuration.empty() ? "" : " of configuration '" + configuration + "'; it has " + known));
  }
  return runs;
}

/// The number in both runs of a pair, averaged over the pairs of each scenario and seed.
struct Paired {
  std::vector<double> a, b;
  std::size_t missing = 0;
};

Paired numbers(const std::vector<Pair>& pairs, const std::string& key) {
  struct Sum {
    double a = 0.0, b = 0.0;
    int count = 0;
  };
  std::map<std::pair<std::string, std::uint64_t>, Sum> units;
  for (const Pair& pair : pairs) {
    Sum& sum = units[{pair.a->scenario, pair.a->seed}];
    const double a = pair.a->metric(key), b = pair.b->metric(key);
    if (std::isnan(a) || std::isnan(b)) continue;
    sum.a += a, sum.b += b, ++sum.count;
  }
  Paired paired;
  for (const auto& [unit, sum] : units) {
    if (sum.count == 0) {
      ++paired.missing;
      continue;
    }
    paired.a.push_back(sum.a / sum.count);
    paired.b.push_back(sum.b / sum.count);
  }
  return paired;
}

Verdict judge(const MetricComparison& c) {
  if (c.better + c.worse == 0) return Verdict::Identical;
  const bool clear = c.interval.low > 0.0 || c.interval.high < 0.0;
  if (!clear || c.p_sign > 0.05) return Verdict::NoEvidence;
  const bool up = c.difference > 0.0;
  // A few large differences one way against many small ones the other way are no evidence for either.
  const bool most_up = c.metric.better == Better::Lower ? c.worse > c.better : c.better > c.worse;
  if (up != most_up) return Verdict::NoEvidence;
  if (c.metric.better == Better::Neither) return up ? Verdict::Higher : Verdict::Lower;
  return up == (c.metric.better == Better::Higher) ? Verdict::Better : Verdict::Worse;
}

MetricComparison compare_metric(const std::vector<Pair>& pairs, const Metric& metric, std::uint64_t seed) {
  MetricComparison c;
  c.metric = metric;
  const Paired paired = numbers(pairs, metric.key);
  c.pairs = paired.a.size();
  c.missing = paired.missing;
  c.mean_a = mean(paired.a);
  c.mean_b = mean(paired.b);
  std::vector<double> differences;
  for (std::size_t i = 0; i < paired.a.size(); ++i) {
    const double difference = paired.b[i] - paired.a[i];
    differences.push_back(difference);
    if (difference == 0.0) continue;
    const bool up = difference > 0.0;
    ++(up == (metric.better != Better::Lower) ? c.better : c.worse);
  }
  c.difference = mean(differences);
  c.interval = bootstrap_mean(differences, seed);
  c.p_sign = sign_test(c.better, c.worse);
  c.verdict = judge(c);
  return c;
}

ComparisonGroup compare_group(const std::string& name, const std::vector<Pair>& pairs,
                              const std::vector<Metric>& metrics, std::uint64_t seed) {
  ComparisonGroup group{name, {}};
  for (const Metric& metric : metrics) {
    MetricComparison c = compare_metric(pairs, metric, seed);
    if (c.pairs > 0) group.metrics.push_back(std::move(c));
  }
  return group;
}

}  // namespace

const char* text_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::Identical:
      return "identical";
    case Verdict::NoEvidence:
      return "no evidence";
    case Verdict::Better:
      return "better";
    case Verdict::Worse:
      return "worse";
    case Verdict::Higher:
      return "higher";
    case Verdict::Lower:
      return "lower";
  }
  return "";
}

Comparison compare(const ResultSet& a, const ResultSet& b, const std::string& name_a, const std::string& name_b,
                   const CompareOptions& options) {
  require_same_score(score_version_of(a.runs, name_a), name_a, score_version_of(b.runs, name_b), name_b);
  const bool named = !options.configuration_a.empty() || !options.configuration_b.empty();
  const std::string only_a =
      named && options.configuration_a.empty() ? options.configuration_b : options.configuration_a;
  const std::string only_b =
      named && options.configuration_b.empty() ? options.configuration_a : options.configuration_b;
  const auto runs_a = by_key(a, name_a, only_a), runs_b = by_key(b, name_b, only_b);
  std::vector<Pair> pairs;
  std::map<std::string, std::vector<Pair>> of_configuration;
  for (const auto& [key, run] : runs_a) {
    const auto partner = runs_b.find(key);
    if (partner == runs_b.end()) continue;
    pairs.push_back({run, partner->second});
    of_configuration[run->configuration].push_back(pairs.back());
  }
  if (pairs.empty())
    throw InputError(name_a + " and " + name_b +
                     ": have no scenario, configuration and seed in common; name configurations with --config-a and "
                     "--config-b");
  Comparison comparison;
  comparison.a = name_a + (only_a.empty() ? "" : " (" + only_a + ")");
  comparison.b = name_b + (only_b.empty() ? "" : " (" + only_b + ")");
  comparison.pairs = pairs.size();
  comparison.only_a = runs_a.size() - pairs.size();
  comparison.only_b = runs_b.size() - pairs.size();
  const std::vector<Metric> metrics = options.all_metrics ? all_metrics(a.runs) : judged_metrics();
  comparison.groups.push_back(compare_group("all", pairs, metrics, options.seed));
  if (options.by_configuration && of_configuration.size() > 1)
    for (const auto& [name, part] : of_configuration)
      comparison.groups.push_back(compare_group(name, part, metrics, options.seed));
  return comparison;
}

}  // namespace rubble::scenarios
