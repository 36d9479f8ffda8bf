#include "explore/paper/prospects.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/distance_transform.h"
#include "base/grid.h"
#include "explore/paper/pushing.h"
#include "explore/plan/frontier.h"
#include "explore/plan/pockets.h"

namespace rubble::explore {
namespace {

constexpr double kHalfGap = 0.20;  ///< a little less than half a body, for walls are drawn thick [m]

/// Where the robot could get to over free floor that is so far from everything the map shows.
Grid<std::uint8_t> within_reach(const OccupancyGrid& cells, Cell from) {
  Grid<std::uint8_t> walls(cells.frame());
  std::transform(cells.cells().begin(), cells.cells().end(), walls.cells().begin(),
                 [](Occupancy o) { return static_cast<std::uint8_t>(o == Occupancy::Occupied); });
  const Grid<float> room = distance_transform(walls, 2.0 * kHalfGap);
  Grid<std::uint8_t> reached(cells.frame());
  if (!cells.inside(from)) return reached;
  std::vector<Cell> open{from};
  reached[from] = 1;
  for (std::size_t next = 0; next < open.size(); ++next) {
    const Cell at = open[next];
    for (const Cell c : {Cell{at.x + 1, at.y}, Cell{at.x, at.y + 1}, Cell{at.x - 1, at.y}, Cell{at.x, at.y - 1}}) {
      if (!cells.inside(c) || reached[c] != 0 || cells[c] != Occupancy::Free) continue;
      // Out of a tight place it gets as it came in.
      if (room[c] < kHalfGap && room[c] < room[at]) continue;
      reached[c] = 1;
      open.push_back(c);
    }
  }
  return reached;
}

}  // namespace

Traversable with_all_pushed(Traversable floor, double pallet, KnownGrids* known) {
  Pushing all(pallet);
  while (all.more()) all.start(floor);
  all.free_things(floor, known);
  return floor;
}

std::size_t prospects(const Traversable& floor, const mrpt::math::TPose2D& T_map_base, int min_cells,
                      const std::function<bool(const mrpt::math::TPoint2D&)>& settled) {
  if (floor.cells.width() == 0) return 0;
  // What costs least is asked first.
  std::vector<FrontierCluster> clusters = frontier_clusters(floor, min_cells);
  const auto keep = [&](const auto& good) {
    const auto none_good = [&](const FrontierCluster& cluster) {
      return std::none_of(cluster.cells.begin(), cluster.cells.end(), good);
    };
    clusters.erase(std::remove_if(clusters.begin(), clusters.end(), none_good), clusters.end());
    return !clusters.empty();
  };
  const auto wanted = [&](Cell c) { return !settled(floor.cells.centre(c)); };
  if (!keep(wanted)) return 0;
  const Grid<std::uint8_t> small = pockets(floor.cells, kPocket);
  const auto leads = [&](Cell c) { return leads_on(floor.cells, small, c) && wanted(c); };
  if (!keep(leads)) return 0;
  const Grid<std::uint8_t> reached = within_reach(floor.cells, floor.cells.cell({T_map_base.x, T_map_base.y}));
  keep([&](Cell c) { return reached[c] != 0 && leads(c); });
  return clusters.size();
}

}  // namespace rubble::explore
