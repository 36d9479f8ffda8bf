#include "scoring/walls/specks.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rubble::scoring {
namespace {

constexpr double kAlone = 0.2;  // [m]
constexpr int kMostCells = 2;   // of a speck
constexpr int kMostNear = 2;    // occupied cells beside it: 1 % of salt has seldom more there

bool occupied(const OccupancyGrid& map, const Cell& c) { return map.inside(c) && map[c] == Occupancy::Occupied; }

int occupied_around(const OccupancyGrid& map, const Cell& c, int reach) {
  int count = 0;
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx)
      if (dx * dx + dy * dy <= reach * reach && occupied(map, {c.x + dx, c.y + dy})) ++count;
  return count;
}

/// The cells connected to `c`, at most one more than a speck has.
int connected(const OccupancyGrid& map, const Cell& c) {
  std::vector<Cell> part = {c};
  for (std::size_t i = 0; i < part.size(); ++i)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell n{part[i].x + dx, part[i].y + dy};
        const auto is_n = [&](const Cell& other) { return other.x == n.x && other.y == n.y; };
        if (!occupied(map, n) || std::any_of(part.begin(), part.end(), is_n)) continue;
        part.push_back(n);
        if (static_cast<int>(part.size()) > kMostCells) return kMostCells + 1;
      }
  return static_cast<int>(part.size());
}

Occupancy surroundings(const OccupancyGrid& map, const Cell& c) {
  int free = 0;
  int unknown = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const Cell n{c.x + dx, c.y + dy};
      const Occupancy there = map.inside(n) ? map[n] : Occupancy::Unknown;
      free += there == Occupancy::Free ? 1 : 0;
      unknown += there == Occupancy::Unknown ? 1 : 0;
    }
  return free > unknown ? Occupancy::Free : Occupancy::Unknown;
}

}  // namespace

OccupancyGrid without_specks(const OccupancyGrid& map) {
  const int reach = std::max(1, static_cast<int>(std::lround(kAlone / map.resolution())));
  OccupancyGrid out = map;
  std::size_t walls = 0;
  std::size_t specks = 0;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const Cell c{x, y};
      if (map[c] != Occupancy::Occupied) continue;
      ++walls;
      const int own = connected(map, c);
      if (own > kMostCells || occupied_around(map, c, reach) - own > kMostNear) continue;
      ++specks;
      out[c] = surroundings(map, c);
    }
  return 2 * specks > walls ? map : out;
}

}  // namespace rubble::scoring
