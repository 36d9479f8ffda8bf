#pragma once

#include <mrpt/math/TPoint2D.h>

#include <vector>

#include "base/grid.h"
#include "base/rng.h"

namespace rubble::arenas {

/// The floor of one pallet of a generated arena, as its glyph: '.' flat, '^' 'v' '<' '>' rising to that side.
struct Tile {
  char shape = '.';
  int level = 0;  ///< height of the foot in ramp rises
  bool is_ramp() const { return shape != '.'; }
};

using Relief = Grid<Tile>;

/// Middle of a pallet [m].
mrpt::math::TPoint2D centre_of(Cell cell);

/// Whether a wheel can cross between two neighbouring pallets: the floors agree along the whole common edge.
bool is_smooth(const Relief& relief, Cell a, Cell b);

/// The neighbours of a pallet that can be reached over a smooth edge, in the order east, north, west, south.
std::vector<Cell> smooth_neighbours(const Relief& relief, Cell cell);

/// Whether every pallet can be reached from every other over smooth edges.
bool is_connected(const Relief& relief);

/// A random relief with about `ramps` ramp pallets (never more), all connected over smooth edges; `start` stays flat.
/// Grows by groups a driver meets in the league: single ramps, ramps side by side that are crossed sideways (roll),
/// ridges, valleys and plateaus (pitch). `tallest`: with 2, some plateaus are two ramps high.
Relief grow_relief(int columns, int rows, int ramps, Cell start, int tallest, Rng& rng);

}  // namespace rubble::arenas
