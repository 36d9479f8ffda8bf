#pragma once

#include <algorithm>

#include "base/grid.h"

namespace rubble::scoring {

/// What each place of a map counts as a wall.
struct WallPieces {
  /// 0..1: extent of the piece of wall here over 0.35 m, 1 at the most; 0 where there is none. A speck hides next to
  /// nothing, and a map with salt is not a map full of walls.
  Grid<float> strength;
  /// The wall that a step over a corner slips through: the lesser of the two cells beside it; 0 for a step over an
  /// edge, and for one that leaves or enters the grid.
  double between(const Cell& from, const Cell& to) const {
    if (from.x == to.x || from.y == to.y || !strength.inside(from) || !strength.inside(to)) return 0.0;
    return static_cast<double>(std::min(strength[{from.x, to.y}], strength[{to.x, from.y}]));
  }
};

/// What becomes of walls that waver so much that they are drawn in dots and strokes (`ragged_walls`).
enum class Ragged { AreWalls, ArePieces };

WallPieces wall_pieces(const OccupancyGrid& grid, Ragged ragged = Ragged::AreWalls);

}  // namespace rubble::scoring
