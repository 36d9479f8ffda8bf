#include "scenarios/evidence/metrics.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

namespace rubble::scenarios {

const std::vector<Metric>& judged_metrics() {
  static const std::vector<Metric> metrics = {
      {"score", "score", Better::Higher, 0.01},
      {"precision", "precision", Better::Higher, 0.01},
      {"recall", "recall", Better::Higher, 0.01},
      {"psi_m", "psi [m]", Better::Lower, 0.01},
      {"ate_first_m", "trajectory error, first pose [m]", Better::Lower, 0.02},
      {"ate_aligned_m", "trajectory error, aligned [m]", Better::Lower, 0.02},
      {"known", "arena known", Better::Higher, 0.01},
      {"aligned", "maps aligned", Better::Higher, 0.0},
      {"victims_found", "victims found", Better::Higher, 0.0},
      {"victims_false", "false victims", Better::Lower, 0.0},
      {"victims_error_m", "victim error [m]", Better::Lower, 0.02},
      {"completed", "runs completed", Better::Higher, 0.0},
  };
  return metrics;
}

std::vector<Metric> all_metrics(const std::vector<RunRecord>& runs) {
  std::vector<Metric> metrics = judged_metrics();
  std::set<std::string> judged, others;
  for (const auto& metric : metrics) judged.insert(metric.key);
  for (const auto& run : runs)
    for (const auto& [key, value] : run.score.items())
      if ((value.is_number() || value.is_boolean()) && judged.count(key) == 0) others.insert(key);
  for (const auto& key : others) metrics.push_back({key, key, Better::Neither, 0.0});
  return metrics;
}

std::string figure(double value) {
  if (std::isnan(value)) return "-";
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

}  // namespace rubble::scenarios
