#pragma once

#include <mrpt/math/TPoint2D.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/grid.h"
#include "base/rng.h"

/// Generated floor plans whose rooms are known: a corridor between two rows of rooms, one door each.
namespace rubble::scoring::testing {

struct PlanSpec {
  int rooms_a_side = 6;
  std::uint64_t seed = 1;
  double resolution = 0.05;  ///< [m]
  double corridor = 2.0;     ///< width [m]
  double door = 0.9;         ///< [m]
  double wall = 0.15;        ///< [m]
  int table_legs = 0;        ///< dots of 2 x 2 cells a room
  int wall_holes = 0;        ///< gaps of 0.1 m in the inner walls
};

struct Plan {
  OccupancyGrid grid;
  Grid<int> truth;  ///< 0: none, 1: the corridor, 2 and up: the rooms
  int rooms = 0;
};

namespace plan_detail {

struct Box {
  double x0, y0, x1, y1;
};

template <class T>
void fill(Grid<T>& grid, const Box& box, T value) {
  const Cell low = grid.cell({box.x0 + 1e-6, box.y0 + 1e-6});
  const Cell high = grid.cell({box.x1 - 1e-6, box.y1 - 1e-6});
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x)
      if (grid.inside({x, y})) grid[{x, y}] = value;
}

}  // namespace plan_detail

inline Plan floor_plan(const PlanSpec& spec) {
  using plan_detail::Box;
  Rng rng(spec.seed, "plan");
  const double margin = 1.0;
  const double depth[2] = {rng.uniform(3.0, 6.0), rng.uniform(3.0, 6.0)};
  std::vector<double> widths[2];
  double length = 0.0;
  for (auto& side : widths) {
    double sum = 0.0;
    for (int i = 0; i < spec.rooms_a_side; ++i) {
      side.push_back(rng.uniform(2.4, 5.0));
      sum += side.back() + spec.wall;
    }
    length = std::max(length, sum);
  }
  const double height = depth[0] + depth[1] + spec.corridor + 4.0 * spec.wall;
  const GridFrame frame{static_cast<int>(std::ceil((length + spec.wall + 2.0 * margin) / spec.resolution)),
                        static_cast<int>(std::ceil((height + 2.0 * margin) / spec.resolution)), spec.resolution,
                        -margin, -margin};
  Plan plan;
  plan.grid = OccupancyGrid(frame);
  plan.truth = Grid<int>(frame, 0);
  plan_detail::fill(plan.grid, Box{0.0, 0.0, length + spec.wall, height}, Occupancy::Occupied);
  const auto room = [&](const Box& box) {
    plan_detail::fill(plan.grid, box, Occupancy::Free);
    plan_detail::fill(plan.truth, box, ++plan.rooms);
    for (int i = 0; plan.rooms > 1 && i < spec.table_legs; ++i) {
      const double x = rng.uniform(box.x0 + 0.3, box.x1 - 0.3);
      const double y = rng.uniform(box.y0 + 0.3, box.y1 - 0.3);
      plan_detail::fill(plan.grid, Box{x, y, x + 0.1, y + 0.1}, Occupancy::Occupied);
    }
  };
  const double south = depth[0] + 2.0 * spec.wall;
  const double north = south + spec.corridor;
  room({spec.wall, south, length, north});
  for (int side = 0; side < 2; ++side) {
    double x = spec.wall;
    for (const double width : widths[side]) {
      const Box box = side == 0 ? Box{x, spec.wall, x + width, south - spec.wall}
                                : Box{x, north + spec.wall, x + width, height - spec.wall};
      room(box);
      const double at = rng.uniform(x + 0.2, x + width - 0.2 - spec.door);
      const double y = side == 0 ? south - spec.wall : north;
      plan_detail::fill(plan.grid, Box{at, y, at + spec.door, y + spec.wall}, Occupancy::Free);
      x += width + spec.wall;
    }
  }
  for (int i = 0; i < spec.wall_holes; ++i) {
    const double x = rng.uniform(1.0, length - 1.0);
    const double y = rng.below(2) == 0 ? south - spec.wall : north;
    plan_detail::fill(plan.grid, Box{x, y, x + 0.1, y + spec.wall}, Occupancy::Free);
  }
  return plan;
}

}  // namespace rubble::scoring::testing
