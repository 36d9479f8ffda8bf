#include "explore/plan/frontier.h"

#include <cstdint>
#include <utility>

#include "explore/plan/set_bytes.h"

namespace rubble::explore {

namespace {

/// 1 where a cell of row y is frontier. Free of branches, so that compilers use vector code.
void mark_row(const Traversable& floor, int y, std::uint8_t* mark) {
  const Occupancy* row = floor.cells.row(y);
  const Occupancy* below = floor.cells.row(y - 1);
  const Occupancy* above = floor.cells.row(y + 1);
  const std::uint8_t* body = floor.body.row(y);
  for (int x = 1; x + 1 < floor.cells.width(); ++x) {
    const bool open = (row[x - 1] == Occupancy::Unknown) | (row[x + 1] == Occupancy::Unknown) |
                      (below[x] == Occupancy::Unknown) | (above[x] == Occupancy::Unknown);
    mark[x] = static_cast<std::uint8_t>((row[x] == Occupancy::Free) & open & (body[x] == 0));
  }
}

}  // namespace

std::vector<Cell> frontier_cells(const Traversable& floor) {
  std::vector<Cell> found;
  std::vector<std::uint8_t> mark(static_cast<std::size_t>(floor.cells.width()));
  for (int y = 1; y + 1 < floor.cells.height(); ++y) {
    mark_row(floor, y, mark.data());
    for_each_set(mark.data(), floor.cells.width(), [&](int x) { found.push_back({x, y}); });
  }
  return found;
}

std::vector<FrontierCluster> frontier_clusters(const Traversable& floor, int min_cells) {
  const std::vector<Cell> frontier = frontier_cells(floor);
  std::vector<FrontierCluster> clusters;
  if (frontier.empty()) return clusters;
  Grid<std::uint8_t> open(floor.frame());
  for (const Cell c : frontier) open[c] = 1;

  for (const Cell first : frontier) {
    if (open[first] == 0) continue;
    FrontierCluster cluster;
    open[first] = 0;
    cluster.cells.push_back(first);
    for (std::size_t next = 0; next < cluster.cells.size(); ++next) {
      const Cell c = cluster.cells[next];
      for (int y = c.y - 1; y <= c.y + 1; ++y)
        for (int x = c.x - 1; x <= c.x + 1; ++x) {
          if (open[{x, y}] == 0) continue;  // the rim is never frontier, so all neighbours are inside
          open[{x, y}] = 0;
          cluster.cells.push_back({x, y});
        }
    }
    if (static_cast<int>(cluster.cells.size()) < min_cells) continue;
    for (const Cell c : cluster.cells) cluster.centroid += floor.cells.centre(c);
    cluster.centroid *= 1.0 / static_cast<double>(cluster.cells.size());
    clusters.push_back(std::move(cluster));
  }
  return clusters;
}

}  // namespace rubble::explore
