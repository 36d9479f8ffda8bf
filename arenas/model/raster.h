#pragma once

#include <algorithm>

#include "arenas/model/arena.h"
#include "arenas/model/geometry.h"
#include "base/grid.h"

namespace rubble::arenas {

constexpr double kRasterTouch = 1e-6;  ///< a solid that ends at a cell's edge is not in that cell [m]

/// Calls visit(cell) for each cell whose centre cross (the two lines from edge middle to edge middle) the convex
/// outline meets. A walk between neighbouring cell centres follows such crosses, so no walk over cells that are not
/// visited gets through the outline, however thin it is, and no cell is visited without need. Cohen-Or and Kaufman
/// 1995, "Fundamentals of surface voxelization": the 4-separating cover.
template <class Visit>
void for_cells_crossed(const GridFrame& frame, const Outline& outline, const Visit& visit) {
  mrpt::math::TPoint2D low = outline[0];
  mrpt::math::TPoint2D high = outline[0];
  for (const mrpt::math::TPoint2D& p : outline) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const Cell first = frame.cell(low);
  const Cell last = frame.cell(high);
  const double half = 0.5 * frame.resolution - kRasterTouch;
  for (int y = std::max(first.y, 0); y <= std::min(last.y, frame.height - 1); ++y) {
    for (int x = std::max(first.x, 0); x <= std::min(last.x, frame.width - 1); ++x) {
      const mrpt::math::TPoint2D c = frame.centre({x, y});
      if (clip(outline, {c.x - half, c.y}, {c.x + half, c.y}) || clip(outline, {c.x, c.y - half}, {c.x, c.y + half})) {
        visit(Cell{x, y});
      }
    }
  }
}

}  // namespace rubble::arenas
