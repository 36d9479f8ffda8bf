#include "scoring/measures/victims.h"

#include "base/assignment.h"

namespace rubble::scoring {

VictimScore score_victims(const std::vector<mrpt::math::TPoint2D>& reported,
                          const std::vector<mrpt::math::TPoint2D>& truth, const mrpt::math::TPose2D& T_truth_map,
                          double reach) {
  VictimScore out;
  out.total = truth.size();
  out.false_alarms = reported.size();
  if (reported.empty() || truth.empty()) return out;

  // A pair out of reach costs more than all pairs within reach together, so the number of matches comes first. Columns
  // beyond the reports stand for "found by nobody" and cost the same. Victims are few and reports may be many.
  const double out_of_reach = (reach + 1.0) * static_cast<double>(truth.size() + 1);
  std::vector<std::vector<double>> cost(truth.size(),
                                        std::vector<double>(reported.size() + truth.size(), out_of_reach));
  for (std::size_t i = 0; i < reported.size(); ++i) {
    const mrpt::math::TPoint2D p = T_truth_map.composePoint(reported[i]);
    for (std::size_t j = 0; j < truth.size(); ++j) {
      const double distance = (p - truth[j]).norm();
      if (distance <= reach) cost[j][i] = distance;
    }
  }
  const std::vector<std::size_t> report_of = assign(cost);
  double sum = 0.0;
  for (std::size_t j = 0; j < truth.size(); ++j) {
    const std::size_t i = report_of[j];
    if (i >= reported.size() || cost[j][i] > reach) continue;
    out.matches.push_back({i, j, cost[j][i]});
    sum += cost[j][i];
  }
  out.found = out.matches.size();
  out.false_alarms = reported.size() - out.found;
  if (out.found > 0) out.mean_error_m = sum / static_cast<double>(out.found);
  return out;
}

}  // namespace rubble::scoring
