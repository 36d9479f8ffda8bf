#pragma once

#include <string>
#include <vector>

#include "scenarios/batch/results.h"
#include "scoring/figures/figures.h"

namespace rubble::scenarios {

/// A number that runs are compared by: a row of the table of figures, or one that only some mapper has.
using Metric = scoring::Figure;
using scoring::Better;

/// The rows of the table that are judged, most important first; then `completed` (did the run end well).
const std::vector<Metric>& judged_metrics();

/// The judged metrics, then every other number that any of the runs has, in alphabetical order.
std::vector<Metric> all_metrics(const std::vector<RunRecord>& runs);

/// 4 significant digits, "-" for NaN, "inf" for infinities.
std::string figure(double value);

}  // namespace rubble::scenarios
