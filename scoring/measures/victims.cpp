#include "scoring/measures/victims.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace rubble::scoring {

std::vector<std::size_t> assign(const std::vector<std::vector<double>>& cost) {
  const std::size_t rows = cost.size();
  if (rows == 0) return {};
  const std::size_t columns = cost.front().size();
  assert(rows <= columns);
  const double infinity = std::numeric_limits<double>::infinity();
  // Row and column 0 are a dummy pair from which each augmenting path starts.
  std::vector<double> row_potential(rows + 1, 0.0);
  std::vector<double> column_potential(columns + 1, 0.0);
  std::vector<std::size_t> row_of(columns + 1, 0);
  std::vector<std::size_t> previous(columns + 1, 0);
  for (std::size_t row = 1; row <= rows; ++row) {
    row_of[0] = row;
    std::size_t column = 0;
    std::vector<double> slack(columns + 1, infinity);
    std::vector<bool> visited(columns + 1, false);
    do {
      visited[column] = true;
      const std::size_t i = row_of[column];
      double delta = infinity;
      std::size_t next = 0;
      for (std::size_t j = 1; j <= columns; ++j) {
        if (visited[j]) continue;
        const double reduced = cost[i - 1][j - 1] - row_potential[i] - column_potential[j];
        if (reduced < slack[j]) {
          slack[j] = reduced;
          previous[j] = column;
        }
        if (slack[j] < delta) {
          delta = slack[j];
          next = j;
        }
      }
      for (std::size_t j = 0; j <= columns; ++j) {
        if (visited[j]) {
          row_potential[row_of[j]] += delta;
          column_potential[j] -= delta;
        } else {
          slack[j] -= delta;
        }
      }
      column = next;
    } while (row_of[column] != 0);
    while (column != 0) {
      row_of[column] = row_of[previous[column]];
      column = previous[column];
    }
  }
  std::vector<std::size_t> column_of(rows, 0);
  for (std::size_t j = 1; j <= columns; ++j)
    if (row_of[j] != 0) column_of[row_of[j] - 1] = j - 1;
  return column_of;
}

VictimScore score_victims(const std::vector<mrpt::math::TPoint2D>& reported,
                          const std::vector<mrpt::math::TPoint2D>& truth, const mrpt::math::TPose2D& T_truth_map,
                          double reach) {
  VictimScore out;
  out.total = truth.size();
  out.false_alarms = reported.size();
  if (reported.empty() || truth.empty()) return out;

  // A pair out of reach costs more than all pairs within reach together, so the number of matches comes first. Columns
  // beyond the victims stand for "belongs to nobody" and cost the same.
  const double out_of_reach = (reach + 1.0) * static_cast<double>(reported.size() + truth.size() + 1);
  std::vector<std::vector<double>> cost(reported.size(),
                                        std::vector<double>(truth.size() + reported.size(), out_of_reach));
  for (std::size_t i = 0; i < reported.size(); ++i) {
    const mrpt::math::TPoint2D p = T_truth_map.composePoint(reported[i]);
    for (std::size_t j = 0; j < truth.size(); ++j) {
      const double distance = (p - truth[j]).norm();
      if (distance <= reach) cost[i][j] = distance;
    }
  }
  const std::vector<std::size_t> victim_of = assign(cost);
  double sum = 0.0;
  for (std::size_t i = 0; i < reported.size(); ++i) {
    if (victim_of[i] >= truth.size() || cost[i][victim_of[i]] > reach) continue;
    out.matches.push_back({i, victim_of[i], cost[i][victim_of[i]]});
    sum += cost[i][victim_of[i]];
  }
  out.found = out.matches.size();
  out.false_alarms = reported.size() - out.found;
  if (out.found > 0) out.mean_error_m = sum / static_cast<double>(out.found);
  return out;
}

}  // namespace rubble::scoring
