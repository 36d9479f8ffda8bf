#include "scenarios/evidence/metrics.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

namespace rubble::scenarios {

namespace {

Metric bare(const std::string& key, const std::string& label, Better better) {
  Metric metric;
  metric.key = key;
  metric.label = label;
  metric.better = better;
  return metric;
}

std::vector<Metric> make_judged() {
  std::vector<Metric> metrics;
  for (const scoring::Figure& figure : scoring::figures())
    if (figure.judged()) metrics.push_back(figure);
  metrics.push_back(bare("completed", "runs completed", Better::Higher));  // of the record, not of its score
  return metrics;
}

}  // namespace

const std::vector<Metric>& judged_metrics() {
  static const std::vector<Metric> metrics = make_judged();
  return metrics;
}

std::vector<Metric> all_metrics(const std::vector<RunRecord>& runs) {
  std::vector<Metric> metrics = judged_metrics();
  std::set<std::string> judged, others;
  for (const auto& metric : metrics) judged.insert(metric.key);
  for (const auto& run : runs)
    for (const auto& [key, value] : run.score->items())
      if ((value.is_number() || value.is_boolean()) && judged.count(key) == 0) others.insert(key);
  for (const auto& key : others) {
    const scoring::Figure* row = scoring::find_figure(key);
    metrics.push_back(row != nullptr ? *row : bare(key, key, Better::Neither));
  }
  return metrics;
}

std::string figure(double value) {
  if (std::isnan(value)) return "-";
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

}  // namespace rubble::scenarios
