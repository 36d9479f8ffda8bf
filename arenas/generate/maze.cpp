#include "arenas/generate/maze.h"

#include <cmath>
#include <utility>

namespace rubble::arenas {
namespace {

/// The flag of the side between two neighbours.
bool& side(Maze& maze, Cell a, Cell b) {
  if (a.x != b.x) return maze[a.x < b.x ? a : b].east;
  return maze[a.y < b.y ? a : b].north;
}

/// Adds the loop-erased random walk from `from` to the tree.
/// `left_to` is scratch: the last way out of each pallet; overwriting it erases the loops.
void join_tree(const Relief& relief, Cell from, Grid<std::uint8_t>& in_tree, Grid<Cell>& left_to, Maze& maze,
               Rng& rng) {
  for (Cell cell = from; in_tree[cell] == 0; cell = left_to[cell]) {
    const std::vector<Cell> ways = smooth_neighbours(relief, cell);
    left_to[cell] = ways[rng.below(static_cast<std::uint32_t>(ways.size()))];
  }
  for (Cell cell = from; in_tree[cell] == 0; cell = left_to[cell]) {
    in_tree[cell] = 1;
    side(maze, cell, left_to[cell]) = true;
  }
}

}  // namespace

bool is_open(const Maze& maze, Cell a, Cell b) {
  if (!maze.inside(a) || !maze.inside(b)) return false;
  if (a.x != b.x) return maze[a.x < b.x ? a : b].east;
  return maze[a.y < b.y ? a : b].north;
}

void set_open(Maze& maze, Cell a, Cell b, bool open) { side(maze, a, b) = open; }

std::vector<Cell> open_neighbours(const Maze& maze, Cell cell) {
  std::vector<Cell> found;
  for (const Cell side : kCellSides) {
    const Cell next{cell.x + side.x, cell.y + side.y};
    if (is_open(maze, cell, next)) found.push_back(next);
  }
  return found;
}

Maze carve_maze(const Relief& relief, double loops, Rng& rng) {
  Maze maze(relief.frame());
  Grid<std::uint8_t> in_tree(relief.frame());
  in_tree[{0, 0}] = 1;
  Grid<Cell> left_to(relief.frame());
  for (int y = 0; y < relief.height(); ++y) {
    for (int x = 0; x < relief.width(); ++x) join_tree(relief, {x, y}, in_tree, left_to, maze, rng);
  }
  std::vector<std::pair<Cell, Cell>> closed;
  for (int y = 0; y < relief.height(); ++y) {
    for (int x = 0; x < relief.width(); ++x) {
      const Cell cell{x, y};
      for (const Cell next : {Cell{x + 1, y}, Cell{x, y + 1}}) {
        if (!relief.inside(next) || is_open(maze, cell, next)) continue;
        closed.push_back({cell, next});
      }
    }
  }
  auto remaining = std::llround(loops * static_cast<double>(closed.size()));
  while (remaining > 0 && !closed.empty()) {
    const std::size_t i = rng.below(static_cast<std::uint32_t>(closed.size()));
    const auto [a, b] = closed[i];
    closed[i] = closed.back();
    closed.pop_back();
    if (!is_smooth(relief, a, b)) continue;
    side(maze, a, b) = true;
    --remaining;
  }
  return maze;
}

}  // namespace rubble::arenas
