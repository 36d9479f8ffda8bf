#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "base/grid.h"
#include "explore/plan/exploration_transform.h"

namespace rubble::test {

/// Eq. (3) the plain way: Dijkstra with a binary heap, costs in double, step lengths 1 : diagonal.
/// Returns the cost of each cell [m]; inf where no source can be reached.
inline Grid<double> heap_transform(const OccupancyGrid& cells, const Grid<float>& clearance,
                                   const std::vector<explore::Source>& sources, const explore::TransformConfig& config,
                                   double diagonal = 17.0 / 12.0) {
  const GridFrame& frame = cells.frame();
  const double inf = std::numeric_limits<double>::infinity();
  Grid<double> weight(frame, inf);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x)
      if (const double d = clearance[{x, y}]; cells[{x, y}] == Occupancy::Free && explore::danger(d, config) < inf)
        weight[{x, y}] = 1.0 + config.alpha * explore::danger(d, config);

  Grid<double> cost(frame, inf);
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  for (const explore::Source& s : sources) {
    if (!(weight[s.cell] < inf) || s.head_start >= cost[s.cell]) continue;
    cost[s.cell] = s.head_start;
    queue.push({s.head_start, frame.index(s.cell)});
  }
  const std::size_t width = static_cast<std::size_t>(frame.width);
  while (!queue.empty()) {
    const auto [value, i] = queue.top();
    queue.pop();
    const Cell c{static_cast<int>(i % width), static_cast<int>(i / width)};
    if (value > cost[c]) continue;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell n{c.x + dx, c.y + dy};
        if ((dx == 0 && dy == 0) || !frame.inside(n)) continue;
        const double step = (dx != 0 && dy != 0 ? diagonal : 1.0) * frame.resolution;
        const double through = value + step * weight[n];
        if (through >= cost[n]) continue;
        cost[n] = through;
        queue.push({through, frame.index(n)});
      }
  }
  return cost;
}

}  // namespace rubble::test
