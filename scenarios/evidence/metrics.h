#pragma once

#include <string>
#include <vector>

#include "scenarios/batch/results.h"

namespace rubble::scenarios {

enum class Better { Higher, Lower, Neither };

/// A number of the score, and how to judge it.
struct Metric {
  std::string key;
  std::string label;
  Better better = Better::Neither;
  double floor = 0.0;  ///< a change of the median smaller than this is of no interest to anybody
};

/// The metrics that are judged, most important first; `completed` (did the run end well) is among them.
const std::vector<Metric>& judged_metrics();

/// The judged metrics, then every other number that any of the runs has, in alphabetical order.
std::vector<Metric> all_metrics(const std::vector<RunRecord>& runs);

/// 4 significant digits, "-" for NaN, "inf" for infinities.
std::string figure(double value);

}  // namespace rubble::scenarios
