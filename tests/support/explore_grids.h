#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/grid.h"
#include "base/rng.h"
#include "explore/plan/traversable.h"

namespace rubble::test {

/// A grid drawn as text, north up: '.' free, '#' occupied, ' ' unknown.
inline OccupancyGrid drawn(const std::vector<std::string>& rows, double resolution = 0.05) {
  GridFrame frame;
  frame.width = static_cast<int>(rows[0].size());
  frame.height = static_cast<int>(rows.size());
  frame.resolution = resolution;
  OccupancyGrid grid(frame, Occupancy::Unknown);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const char glyph = rows[static_cast<std::size_t>(frame.height - 1 - y)][static_cast<std::size_t>(x)];
      if (glyph == '.') grid[{x, y}] = Occupancy::Free;
      if (glyph == '#') grid[{x, y}] = Occupancy::Occupied;
    }
  return grid;
}

/// Free floor with random blocks of obstacles and of unknown; the rim is unknown.
inline OccupancyGrid random_grid(int width, int height, std::uint64_t seed) {
  Rng rng(seed, "test grid");
  GridFrame frame;
  frame.width = width;
  frame.height = height;
  OccupancyGrid grid(frame, Occupancy::Free);
  const int blocks = width * height / 60;
  for (int i = 0; i < blocks; ++i) {
    const int x0 = static_cast<int>(rng.below(static_cast<std::uint32_t>(width)));
    const int y0 = static_cast<int>(rng.below(static_cast<std::uint32_t>(height)));
    const int x1 = x0 + static_cast<int>(rng.below(5));
    const int y1 = y0 + static_cast<int>(rng.below(5));
    const Occupancy what = rng.below(3) == 0 ? Occupancy::Unknown : Occupancy::Occupied;
    for (int y = y0; y <= y1 && y < height; ++y)
      for (int x = x0; x <= x1 && x < width; ++x) grid[{x, y}] = what;
  }
  for (int x = 0; x < width; ++x) grid[{x, 0}] = grid[{x, height - 1}] = Occupancy::Unknown;
  for (int y = 0; y < height; ++y) grid[{0, y}] = grid[{width - 1, y}] = Occupancy::Unknown;
  return grid;
}

/// A walled room of free floor, width x height [m] with its walls, its south-west corner at the origin.
inline OccupancyGrid room(double width, double height, double resolution = 0.05) {
  GridFrame frame;
  frame.resolution = resolution;
  frame.x0 = frame.y0 = -resolution;  // the rim is unknown
  frame.width = static_cast<int>(width / resolution + 0.5) + 2;
  frame.height = static_cast<int>(height / resolution + 0.5) + 2;
  OccupancyGrid grid(frame, Occupancy::Unknown);
  for (int y = 1; y + 1 < frame.height; ++y)
    for (int x = 1; x + 1 < frame.width; ++x) {
      const bool wall = x == 1 || y == 1 || x + 2 == frame.width || y + 2 == frame.height;
      grid[{x, y}] = wall ? Occupancy::Occupied : Occupancy::Free;
    }
  return grid;
}

/// Fills a rectangle [m] of a grid.
inline void fill(OccupancyGrid& grid, double x0, double y0, double x1, double y1, Occupancy what) {
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) {
      const auto p = grid.centre({x, y});
      if (p.x > x0 && p.x < x1 && p.y > y0 && p.y < y1) grid[{x, y}] = what;
    }
}

inline constexpr double kPallet = 1.2;

/// A corridor of eight pallets along x, with rooms to the north, shut by a wall at `x` that is `width` [m] wide, with
/// `behind` it.
inline OccupancyGrid corridor_of_pallets(double x, double width, Occupancy behind) {
  OccupancyGrid cells = room(8 * kPallet, 2 * kPallet);
  fill(cells, 0.0, kPallet - 0.03, 8 * kPallet, kPallet + 0.03, Occupancy::Occupied);
  for (const int k : {1, 2, 4, 5, 7})
    fill(cells, k * kPallet - 0.03, kPallet, k * kPallet + 0.03, 2 * kPallet, Occupancy::Occupied);
  fill(cells, x, 0.06, 8 * kPallet - 0.06, kPallet - 0.06, behind);
  fill(cells, x - 0.03, 0.0, x + 0.03, width, Occupancy::Occupied);
  return cells;
}

inline explore::Traversable measured(OccupancyGrid grid, double cap = 1.2) {
  explore::Traversable floor = explore::traversable(std::move(grid));
  explore::measure_clearance(floor, cap);
  return floor;
}

}  // namespace rubble::test
