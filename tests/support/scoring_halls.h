#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/rng.h"
#include "tests/support/scoring_maze.h"

/// Places with next to nothing inside: a score has only the walls around them to go by.
namespace rubble::scoring::testing {

/// A rectangle, an L, a rectangle with one block, one with one short wall, in turn by seed; sides of 2.4 to 9.6 m.
/// `lattice`: sides are whole pallets.
inline OccupancyGrid hall_of(std::uint64_t seed, bool lattice = false) {
  constexpr double kCell = 0.05;
  constexpr double kMargin = 0.5;
  constexpr double kPallet = 1.2;
  Rng rng(seed, "hall");
  const auto side = [&](double least, double most) {
    const double metres = least + (most - least) * rng.uniform();
    const double step = lattice ? kPallet : kCell;
    return std::max(step, step * std::round(metres / step));
  };
  const double width = side(2.4, 9.6);
  const double height = side(2.4, 9.6);
  const double cut_x = side(0.3 * width, 0.6 * width);
  const double cut_y = side(0.3 * height, 0.6 * height);
  OccupancyGrid out(GridFrame{static_cast<int>(std::lround((width + 2.0 * kMargin) / kCell)),
                              static_cast<int>(std::lround((height + 2.0 * kMargin) / kCell)), kCell, -kMargin,
                              -kMargin});
  const bool is_l = seed % 4 == 1;
  const auto inside = [&](const TPoint2D& p, double grow) {
    if (p.x < -grow || p.y < -grow || p.x > width + grow || p.y > height + grow) return false;
    return !is_l || p.x < width - cut_x + grow || p.y < height - cut_y + grow;
  };
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const TPoint2D p = out.centre({x, y});
      if (inside(p, 0.05)) out[{x, y}] = inside(p, -0.05) ? Occupancy::Free : Occupancy::Occupied;
    }
  const TPoint2D at(cut_x, cut_y);
  if (seed % 4 == 2)
    for (const double y : {-0.3, 0.25}) draw_wall(out, at + TPoint2D(-0.3, y), at + TPoint2D(0.3, y), 2);
  if (seed % 4 == 2)
    for (const double x : {-0.3, 0.25}) draw_wall(out, at + TPoint2D(x, -0.3), at + TPoint2D(x, 0.3), 2);
  if (seed % 4 == 3) draw_wall(out, at, at + TPoint2D(0.0, std::min(kPallet, height - cut_y)), 2);
  return out;
}

/// Four pallets to the north and two more to the east, with a wall across the corridor at two places.
inline OccupancyGrid corridor_of_pallets() {
  constexpr double kPallet = 1.2;
  OccupancyGrid out(GridFrame{100, 120, 0.05, -0.5, -0.5});
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const TPoint2D p = out.centre({x, y});
      const bool north = p.x > 0.0 && p.x < kPallet && p.y > 0.0 && p.y < 4.0 * kPallet;
      const bool east = p.x > 0.0 && p.x < 3.0 * kPallet && p.y > 3.0 * kPallet && p.y < 4.0 * kPallet;
      if (north || east) out[{x, y}] = Occupancy::Free;
    }
  const auto wall = [&](double ax, double ay, double bx, double by) {
    draw_wall(out, {ax * kPallet, ay * kPallet}, {bx * kPallet, by * kPallet}, 2);
  };
  wall(0, 0, 0, 4);
  wall(0, 4, 3, 4);
  wall(3, 4, 3, 3);
  wall(3, 3, 1, 3);
  wall(1, 3, 1, 0);
  wall(1, 0, 0, 0);
  wall(0, 2, 1, 2);
  wall(1, 3, 1, 4);
  return out;
}

}  // namespace rubble::scoring::testing
