#include "explore/caution/step_field.h"

namespace rubble::explore {
namespace {

constexpr double kSpread = 0.6;  ///< [m]

}  // namespace

bool shows_step_field(const OccupancyGrid& cells, const PalletGrid& grid, Cell pallet) {
  const mrpt::math::TPoint2D middle = grid.middle(pallet);
  const Cell low = cells.cell({middle.x - grid.size, middle.y - grid.size});
  const Cell high = cells.cell({middle.x + grid.size, middle.y + grid.size});
  Extent extent;
  for (int y = std::max(0, low.y); y <= std::min(cells.height() - 1, high.y); ++y)
    for (int x = std::max(0, low.x); x <= std::min(cells.width() - 1, high.x); ++x) {
      if (cells[{x, y}] != Occupancy::Occupied) continue;
      const mrpt::math::TPoint2D p = cells.centre({x, y});
      if (grid.pallet(p) == pallet && grid.depth(p) > kInsidePallet) extent.add(grid.to_grid(p));
    }
  return grid.size * std::min(extent.x.length(), extent.y.length()) > kSpread;
}

}  // namespace rubble::explore
