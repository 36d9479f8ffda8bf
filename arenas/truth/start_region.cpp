#include "arenas/truth/start_region.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#include "arenas/truth/truth_map.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

constexpr double kCoarse = 0.1;                  ///< [m]
constexpr double kCellArea = kCoarse * kCoarse;  ///< [m2]

/// The cells of a floor on which the robot's middle can stand.
using Region = std::vector<Cell>;

/// The cells not yet `known` that are connected with `from`, which become known.
Region grow(const Grid<float>& room, float needed, Cell from, Grid<std::uint8_t>& known) {
  Region region{from};
  known[from] = 1;
  for (std::size_t i = 0; i < region.size(); ++i) {
    for (const Cell side : kCellSides) {
      const Cell next{region[i].x + side.x, region[i].y + side.y};
      if (!room.inside(next) || known[next] != 0 || room[next] < needed) continue;
      known[next] = 1;
      region.push_back(next);
    }
  }
  return region;
}

/// Where the robot could start in there, far from all that stands around.
std::optional<TPoint2D> roomy_place(const Region& region, const Grid<float>& room, Arena arena) {
  constexpr std::size_t kTries = 40;
  Region places = region;
  std::stable_sort(places.begin(), places.end(), [&](Cell a, Cell b) { return room[a] > room[b]; });
  for (std::size_t i = 0; i < std::min(kTries, places.size()); ++i) {
    const TPoint2D p = room.frame().centre(places[i]);
    arena.start = {p.x, p.y, arena.start.phi};
    if (!start_trouble(arena)) return p;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> small_start(const Arena& arena, const Viewer& viewer) {
  const OccupancyGrid drawn = drawn_map(arena, kCoarse);
  const Grid<float> room = standing_room(arena, drawn, viewer);
  const Grid<std::uint8_t> reached = reachable_mask({arena.start.x, arena.start.y}, drawn, room, viewer);
  const auto own = static_cast<std::size_t>(std::count(reached.cells().begin(), reached.cells().end(), 1));
  const auto needed = static_cast<float>(viewer.radius);
  Grid<std::uint8_t> known = reached;
  std::size_t all = own;
  std::vector<Region> larger;
  for (int y = 0; y < room.height(); ++y) {
    for (int x = 0; x < room.width(); ++x) {
      if (known[{x, y}] != 0 || room[{x, y}] < needed) continue;
      Region region = grow(room, needed, {x, y}, known);
      all += region.size();
      if (region.size() > own) larger.push_back(std::move(region));
    }
  }
  if (static_cast<double>(own) >= kSmallShare * static_cast<double>(all)) return std::nullopt;
  const auto area = [](std::size_t cells) { return kCellArea * static_cast<double>(cells); };
  std::array<char, 160> text{};
  std::snprintf(
      text.data(), text.size(),
      "from the start (%.2f, %.2f) the robot gets to %.1f m2 of floor, %.0f %% of %.1f m2, a wall or step all "
      "round; ",
      arena.start.x, arena.start.y, area(own), 100.0 * static_cast<double>(own) / static_cast<double>(all), area(all));
  const std::string what = text.data();
  std::stable_sort(larger.begin(), larger.end(), [](const Region& a, const Region& b) { return a.size() > b.size(); });
  for (const Region& region : larger) {
    const auto better = roomy_place(region, room, arena);
    if (!better) continue;
    std::snprintf(
        text.data(), text.size(),
        "with start: {x_m: %.2f, y_m: %.2f}, or the drawing's S there, it would get to %.1f m2: move the start",
        better->x, better->y, area(region.size()));
    return what + text.data();
  }
  return what + "no larger part has room for a start: open a wall or lay a ramp to the rest";
}

}  // namespace rubble::arenas
