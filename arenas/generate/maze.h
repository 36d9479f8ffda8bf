#pragma once

#include <vector>

#include "arenas/model/relief.h"
#include "base/grid.h"
#include "base/rng.h"

namespace rubble::arenas {

/// Which sides of a pallet are open; west and south follow from the neighbours.
struct Passages {
  bool east = false;
  bool north = false;
};

using Maze = Grid<Passages>;

bool is_open(const Maze& maze, Cell a, Cell b);
/// Opens or closes the edge between two neighbours of the maze.
void set_open(Maze& maze, Cell a, Cell b, bool open);

/// Neighbours behind open sides, in the order east, north, west, south.
std::vector<Cell> open_neighbours(const Maze& maze, Cell cell);

/// A uniformly drawn spanning tree of the smooth edges (Wilson 1996), then `loops` of the perfect maze's inner walls
/// taken away where the floor is smooth. The relief must be connected.
Maze carve_maze(const Relief& relief, double loops, Rng& rng);

}  // namespace rubble::arenas
