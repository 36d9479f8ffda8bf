#pragma once

#include <mrpt/math/TPose2D.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "base/angle.h"
#include "base/grid.h"
#include "base/rng.h"

/// Small synthetic mazes and seeded damage to them. Damage of one kind and seed is nested: more of it contains less.
namespace rubble::scoring::testing {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

struct MazeSpec {
  int columns = 8;  ///< pallets
  int rows = 8;
  std::uint64_t seed = 1;
  double cell = 1.2;         ///< [m]
  double resolution = 0.05;  ///< [m]
  int wall_cells = 2;        ///< thickness of a wall
  double loops = 0.2;        ///< share of the inner walls taken away again
  double margin = 0.5;       ///< unknown around it [m]
};

/// Axis-parallel wall pieces of a random maze: pairs of end points [m].
inline std::vector<std::pair<TPoint2D, TPoint2D>> maze_walls(const MazeSpec& spec) {
  Rng rng(spec.seed, "maze");
  const auto id = [&](int x, int y) { return static_cast<std::size_t>(y * spec.columns + x); };
  std::vector<std::size_t> group(static_cast<std::size_t>(spec.columns * spec.rows));
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto find = [&](std::size_t i) {
    while (group[i] != i) i = group[i];
    return i;
  };
  struct Edge {
    int x, y;
    bool vertical;
  };
  std::vector<Edge> edges;
  for (int y = 0; y < spec.rows; ++y)
    for (int x = 0; x < spec.columns; ++x) {
      if (x + 1 < spec.columns) edges.push_back({x, y, true});
      if (y + 1 < spec.rows) edges.push_back({x, y, false});
    }
  for (std::size_t i = edges.size(); i > 1; --i) {
    const std::size_t j = rng.below(static_cast<std::uint32_t>(i));
    std::swap(edges[i - 1], edges[j]);
  }
  const double c = spec.cell;
  const double w = c * spec.columns;
  const double h = c * spec.rows;
  std::vector<std::pair<TPoint2D, TPoint2D>> walls = {
      {{0, 0}, {w, 0}}, {{0, h}, {w, h}}, {{0, 0}, {0, h}}, {{w, 0}, {w, h}}};
  for (const Edge& e : edges) {
    const std::size_t a = find(id(e.x, e.y));
    const std::size_t b = find(e.vertical ? id(e.x + 1, e.y) : id(e.x, e.y + 1));
    const double draw = rng.uniform();
    if (a != b) {
      group[a] = b;
      continue;
    }
    if (draw < spec.loops) continue;
    if (e.vertical)
      walls.push_back({{(e.x + 1) * c, e.y * c}, {(e.x + 1) * c, (e.y + 1) * c}});
    else
      walls.push_back({{e.x * c, (e.y + 1) * c}, {(e.x + 1) * c, (e.y + 1) * c}});
  }
  return walls;
}

inline void draw_wall(OccupancyGrid& grid, const TPoint2D& a, const TPoint2D& b, int thickness) {
  const double half = 0.5 * thickness * grid.resolution();
  const int steps = std::max(1, static_cast<int>(std::ceil((b - a).norm() / (0.4 * grid.resolution()))));
  for (int i = 0; i <= steps; ++i) {
    const TPoint2D p(a.x + (b.x - a.x) * i / steps, a.y + (b.y - a.y) * i / steps);
    const Cell low = grid.cell({p.x - half + 1e-6, p.y - half + 1e-6});
    for (int dy = 0; dy < thickness; ++dy)
      for (int dx = 0; dx < thickness; ++dx)
        if (grid.inside({low.x + dx, low.y + dy})) grid[{low.x + dx, low.y + dy}] = Occupancy::Occupied;
  }
}

inline OccupancyGrid maze(const MazeSpec& spec = {}) {
  GridFrame frame;
  frame.resolution = spec.resolution;
  frame.x0 = -spec.margin;
  frame.y0 = -spec.margin;
  frame.width = static_cast<int>(std::lround((spec.cell * spec.columns + 2 * spec.margin) / spec.resolution));
  frame.height = static_cast<int>(std::lround((spec.cell * spec.rows + 2 * spec.margin) / spec.resolution));
  OccupancyGrid grid(frame);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const TPoint2D p = grid.centre({x, y});
      if (p.x > 0 && p.y > 0 && p.x < spec.cell * spec.columns && p.y < spec.cell * spec.rows)
        grid[{x, y}] = Occupancy::Free;
    }
  for (const auto& wall : maze_walls(spec)) draw_wall(grid, wall.first, wall.second, spec.wall_cells);
  return grid;
}

inline OccupancyGrid maze_of(std::uint64_t seed, int columns, int rows) {
  MazeSpec spec;
  spec.columns = columns;
  spec.rows = rows;
  spec.seed = seed;
  return maze(spec);
}

/// The image turned and shifted, nearest neighbour, on a canvas that holds all of it.
inline OccupancyGrid moved(const OccupancyGrid& grid, double angle, double dx, double dy, double resolution = 0.0) {
  const GridFrame& f = grid.frame();
  const double res = resolution > 0.0 ? resolution : f.resolution;
  const TPose2D T(dx, dy, angle);
  double x_min = 1e9, x_max = -1e9, y_min = 1e9, y_max = -1e9;
  for (const double u : {0.0, 1.0})
    for (const double v : {0.0, 1.0}) {
      const TPoint2D p =
          T.composePoint(TPoint2D(f.x0 + u * f.width * f.resolution, f.y0 + v * f.height * f.resolution));
      x_min = std::min(x_min, p.x);
      x_max = std::max(x_max, p.x);
      y_min = std::min(y_min, p.y);
      y_max = std::max(y_max, p.y);
    }
  OccupancyGrid out(GridFrame{static_cast<int>(std::ceil((x_max - x_min) / res)),
                              static_cast<int>(std::ceil((y_max - y_min) / res)), res, x_min, y_min});
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const Cell c = grid.cell(T.inverseComposePoint(out.centre({x, y})));
      if (grid.inside(c)) out[{x, y}] = grid[c];
    }
  return out;
}

inline OccupancyGrid mirrored(const OccupancyGrid& grid) {
  OccupancyGrid out(grid.frame());
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) out[{grid.width() - 1 - x, y}] = grid[{x, y}];
  return out;
}

inline OccupancyGrid padded(const OccupancyGrid& grid, int cells) {
  GridFrame frame = grid.frame();
  frame.x0 -= cells * frame.resolution;
  frame.y0 -= cells * frame.resolution;
  frame.width += 2 * cells;
  frame.height += 2 * cells;
  OccupancyGrid out(frame);
  for (int y = 0; y < grid.height(); ++y)
    std::copy(grid.row(y), grid.row(y) + grid.width(), out.row(y + cells) + cells);
  return out;
}

/// The same cells said to be of another size: a scale error.
inline OccupancyGrid scaled(const OccupancyGrid& grid, double factor) {
  GridFrame frame = grid.frame();
  frame.resolution *= factor;
  OccupancyGrid out(frame);
  out.cells() = grid.cells();
  return out;
}

/// Sheared along a parabola across the map: `bend` metres of sag at the ends relative to the middle.
inline OccupancyGrid bent(const OccupancyGrid& source, double bend) {
  const OccupancyGrid grid = padded(source, static_cast<int>(std::ceil(bend / source.resolution())) + 1);
  OccupancyGrid out(grid.frame());
  const double middle = 0.5 * grid.width();
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) {
      const double u = (x - middle) / middle;
      const int from = y - static_cast<int>(std::lround(bend * u * u / grid.resolution()));
      if (from >= 0 && from < grid.height()) out[{x, y}] = grid[{x, from}];
    }
  return out;
}

inline OccupancyGrid with_phantoms(const OccupancyGrid& source, int count, std::uint64_t seed) {
  OccupancyGrid out = source;
  Rng rng(seed, "phantoms");
  const GridFrame& f = source.frame();
  for (int i = 0; i < count; ++i) {
    const double x = rng.uniform(f.x0 + 1.0, f.x0 + f.width * f.resolution - 1.0);
    const double y = rng.uniform(f.y0 + 1.0, f.y0 + f.height * f.resolution - 1.0);
    const double angle = rng.uniform(0.0, kPi);
    draw_wall(out, {x - 0.5 * std::cos(angle), y - 0.5 * std::sin(angle)},
              {x + 0.5 * std::cos(angle), y + 0.5 * std::sin(angle)}, 2);
  }
  return out;
}

/// Walls within discs of 0.4 m radius are turned into free space.
inline OccupancyGrid with_gaps(const OccupancyGrid& source, int count, std::uint64_t seed) {
  OccupancyGrid out = source;
  std::vector<Cell> walls;
  for (int y = 0; y < source.height(); ++y)
    for (int x = 0; x < source.width(); ++x)
      if (source[{x, y}] == Occupancy::Occupied) walls.push_back({x, y});
  Rng rng(seed, "gaps");
  const int radius = static_cast<int>(std::lround(0.4 / source.resolution()));
  for (int i = 0; i < count; ++i) {
    const Cell c = walls[rng.below(static_cast<std::uint32_t>(walls.size()))];
    for (int dy = -radius; dy <= radius; ++dy)
      for (int dx = -radius; dx <= radius; ++dx) {
        const Cell n{c.x + dx, c.y + dy};
        if (dx * dx + dy * dy <= radius * radius && out.inside(n) && out[n] == Occupancy::Occupied)
          out[n] = Occupancy::Free;
      }
  }
  return out;
}

inline OccupancyGrid thickened(const OccupancyGrid& source, int cells) {
  OccupancyGrid out = source;
  for (int y = 0; y < source.height(); ++y)
    for (int x = 0; x < source.width(); ++x) {
      if (source[{x, y}] != Occupancy::Occupied) continue;
      for (int dy = -cells; dy <= cells; ++dy)
        for (int dx = -cells; dx <= cells; ++dx)
          if (dx * dx + dy * dy <= cells * cells && out.inside({x + dx, y + dy}))
            out[{x + dx, y + dy}] = Occupancy::Occupied;
    }
  return out;
}

/// Only the south-western part stays known: the columns and rows up to `share` of the map's area.
inline OccupancyGrid with_coverage(const OccupancyGrid& source, double share) {
  OccupancyGrid out = source;
  const double side = std::sqrt(share);
  for (int y = 0; y < source.height(); ++y)
    for (int x = 0; x < source.width(); ++x)
      if (x > side * source.width() || y > side * source.height()) out[{x, y}] = Occupancy::Unknown;
  return out;
}

/// Salt: this share of the free cells turned into walls, one by one.
inline OccupancyGrid with_salt(const OccupancyGrid& source, double share, std::uint64_t seed) {
  OccupancyGrid out = source;
  Rng rng(seed, "salt");
  for (Occupancy& cell : out.cells()) {
    const double draw = rng.uniform();
    if (cell == Occupancy::Free && draw < share) cell = Occupancy::Occupied;
  }
  return out;
}

/// Walls a cell thicker to each side.
inline OccupancyGrid grown(const OccupancyGrid& source) {
  OccupancyGrid out = source;
  for (int y = 0; y < source.height(); ++y)
    for (int x = 0; x < source.width(); ++x)
      for (int v = -1; v <= 1; ++v)
        for (int u = -1; u <= 1; ++u)
          if (source[{x, y}] == Occupancy::Occupied && out.inside({x + u, y + v}))
            out[{x + u, y + v}] = Occupancy::Occupied;
  return out;
}

/// Gaps between walls closed with a square of three cells.
inline OccupancyGrid closed(const OccupancyGrid& source) {
  const OccupancyGrid wide = grown(source);
  OccupancyGrid out = wide;
  for (int y = 0; y < wide.height(); ++y)
    for (int x = 0; x < wide.width(); ++x)
      for (int v = -1; v <= 1; ++v)
        for (int u = -1; u <= 1; ++u)
          if (wide[{x, y}] != Occupancy::Occupied && out.inside({x + u, y + v}))
            out[{x + u, y + v}] = source[{x + u, y + v}];
  return out;
}

/// What a laser map looks like: the walls ragged by up to `cells` cells.
inline OccupancyGrid ragged(const OccupancyGrid& source, int cells, std::uint64_t seed) {
  OccupancyGrid out = source;
  Rng rng(seed, "ragged");
  for (Occupancy& cell : out.cells())
    if (cell == Occupancy::Occupied) cell = Occupancy::Free;
  for (int y = 0; y < source.height(); ++y)
    for (int x = 0; x < source.width(); ++x) {
      const std::uint32_t span = static_cast<std::uint32_t>(2 * cells + 1);
      const int dx = static_cast<int>(rng.below(span)) - cells;
      const int dy = static_cast<int>(rng.below(span)) - cells;
      if (source[{x, y}] == Occupancy::Occupied && out.inside({x + dx, y + dy}))
        out[{x + dx, y + dy}] = Occupancy::Occupied;
    }
  return out;
}

}  // namespace rubble::scoring::testing
