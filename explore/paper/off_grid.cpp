#include "explore/paper/off_grid.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "explore/caution/local_grids.h"
#include "explore/caution/step_field.h"
#include "explore/plan/loose_things.h"
#include "explore/plan/set_bytes.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;

constexpr int kJoined = 2;           ///< what is so near hangs together [cells]
constexpr double kWide = 0.5;        ///< what is as wide may be a wall, if it is no floor [m]
constexpr double kSideThick = 0.12;  ///< the side of a box that stands on an edge is no thicker [m]
constexpr double kSideReach = 0.3;   ///< and reaches no farther beyond kInsidePallet [m]
constexpr double kSideShown = 0.7;   ///< and so much of it shows between there and the edge

bool occupied_near(const OccupancyGrid& cells, const TPoint2D& p_map) {
  const Cell c = cells.cell(p_map);
  for (int y = c.y - 1; y <= c.y + 1; ++y)
    for (int x = c.x - 1; x <= c.x + 1; ++x)
      if (cells.inside({x, y}) && cells[{x, y}] == Occupancy::Occupied) return true;
  return false;
}

Extent extent_of(const OccupancyGrid& cells, const PalletGrid& grid, const Thing& thing) {
  Extent extent;
  for (const Cell c : thing.cells) extent.add(grid.to_grid(cells.centre(c)));
  return extent;
}

/// Whether a thing inside a pallet is the end of a panel that stands upright on an edge of it, as the sides of the
/// boxes of victims do.
bool is_side_of_box(const OccupancyGrid& cells, const PalletGrid& grid, const Extent& extent) {
  const auto& [x, y] = extent;
  const double step = cells.frame().resolution / grid.size;
  const bool along_x = x.length() >= y.length();
  const Range& along = along_x ? x : y;
  const Range& across = along_x ? y : x;
  if (across.length() + step > kSideThick / grid.size || along.length() + step > kSideReach / grid.size) return false;
  const double edge = std::round(along.middle());
  const double from = edge < along.middle() ? along.low : along.high;
  const double way = edge - from;
  const int steps = std::max(1, static_cast<int>(std::lround(std::abs(way) / step)));
  int shown = 0;
  for (int i = 1; i <= steps; ++i) {
    const double at = from + way * i / steps;
    const TPoint2D p = along_x ? TPoint2D{at, across.middle()} : TPoint2D{across.middle(), at};
    shown += occupied_near(cells, grid.to_map(p)) ? 1 : 0;
  }
  return shown >= kSideShown * steps;
}

/// Takes what lies nearer to the edges and hangs together with a thing into it, and out of `inside`.
void add_what_joins(OccupancyGrid& inside, Thing& thing) {
  for (std::size_t next = 0; next < thing.cells.size(); ++next) {
    const Cell c = thing.cells[next];
    for (int y = std::max(0, c.y - kJoined); y <= std::min(inside.height() - 1, c.y + kJoined); ++y)
      for (int x = std::max(0, c.x - kJoined); x <= std::min(inside.width() - 1, c.x + kJoined); ++x) {
        if (inside[{x, y}] != Occupancy::Unknown) continue;
        inside[{x, y}] = Occupancy::Free;
        thing.cells.push_back({x, y});
      }
  }
}

}  // namespace

bool free_off_grid(Traversable& floor, double pallet, bool floor_only, KnownGrids* known) {
  if (pallet <= 0.0) return false;
  const OccupancyGrid walls = floor.cells;
  LocalGrids grids(walls, pallet, known);
  // Occupied: well inside a pallet. Unknown: nearer to its edges than that, as a part of what stands inside may be.
  OccupancyGrid inside(walls.frame(), Occupancy::Free);
  for (int y = 0; y < walls.height(); ++y)
    for_each_occupied(walls.row(y), 0, walls.width(), [&](int x) {
      const TPoint2D p = walls.centre({x, y});
      const std::optional<PalletGrid>& grid = grids.at(p);
      const double depth = grid ? grid->depth(p) : 0.0;
      if (depth > kOnAnEdge) inside[{x, y}] = depth > kInsidePallet ? Occupancy::Occupied : Occupancy::Unknown;
    });
  bool any = false;
  for (Thing& thing : things_of(inside, 1)) {
    const TPoint2D at = walls.centre(thing.cells[thing.cells.size() / 2]);
    const std::optional<PalletGrid>& grid = grids.at(at);
    if (!grid || shows_step_field(walls, *grid, grid->pallet(at)) ||
        is_side_of_box(walls, *grid, extent_of(walls, *grid, thing)))
      continue;
    add_what_joins(inside, thing);
    const bool wide = thing.longer_side() * walls.frame().resolution >= kWide;
    if (floor_only && !wide) continue;
    if (wide && std::any_of(thing.cells.begin(), thing.cells.end(), [&](Cell c) { return floor.solid[c] != 0; }))
      continue;
    (wide ? doubt : loosen)(floor, thing);
    any = true;
  }
  return any;
}

}  // namespace rubble::explore
