#include "explore/paper/off_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "explore/caution/local_grids.h"
#include "explore/plan/loose_things.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;

constexpr double kInside = 0.2;      ///< so far inside its pallet nothing is a wall on an edge [m]
constexpr double kSideThick = 0.12;  ///< the side of a box that stands on an edge is no thicker [m]
constexpr double kSideReach = 0.3;   ///< and reaches no farther beyond kInside [m]
constexpr double kSideShown = 0.7;   ///< and so much of it shows between there and the edge

/// A range of numbers.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  double length() const { return high - low; }
  double middle() const { return 0.5 * (low + high); }
};

bool occupied_near(const OccupancyGrid& cells, const TPoint2D& p_map) {
  const Cell c = cells.cell(p_map);
  for (int y = c.y - 1; y <= c.y + 1; ++y)
    for (int x = c.x - 1; x <= c.x + 1; ++x)
      if (cells.inside({x, y}) && cells[{x, y}] == Occupancy::Occupied) return true;
  return false;
}

/// Whether a thing inside a pallet is the end of a panel that stands upright on an edge of it, as the sides of the
/// boxes of victims do.
bool is_side_of_box(const OccupancyGrid& cells, const PalletGrid& grid, const Thing& thing) {
  Range x, y;  // [pallets]
  for (const Cell c : thing.cells) {
    const TPoint2D p = grid.to_grid(cells.centre(c));
    x.add(p.x);
    y.add(p.y);
  }
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

}  // namespace

bool free_off_grid(Traversable& floor, double pallet) {
  if (pallet <= 0.0) return false;
  const OccupancyGrid walls = floor.cells;
  LocalGrids grids(walls, pallet);
  OccupancyGrid inside(walls.frame(), Occupancy::Free);
  for (int y = 0; y < walls.height(); ++y)
    for (int x = 0; x < walls.width(); ++x) {
      if (walls[{x, y}] != Occupancy::Occupied) continue;
      const TPoint2D p = walls.centre({x, y});
      const std::optional<PalletGrid>& grid = grids.at(p);
      if (grid && grid->depth(p) > kInside) inside[{x, y}] = Occupancy::Occupied;
    }
  bool any = false;
  for (const Thing& thing : things_of(inside, 1)) {
    const std::optional<PalletGrid>& grid = grids.at(walls.centre(thing.cells.front()));
    if (!grid || is_side_of_box(walls, *grid, thing)) continue;
    loosen(floor, thing);
    any = true;
  }
  return any;
}

}  // namespace rubble::explore
