#include "scoring/overlap.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "scoring/rigid.h"
#include "scoring/wall_field.h"

namespace rubble::scoring {
namespace {

double kernel(double distance, double tau) { return std::clamp(1.0 - distance / tau, 0.0, 1.0); }

/// From a point to the nearest wall cell, not to its centre: what lies on a wall cell is on the wall.
double to_wall(const WallField& field, const mrpt::math::TPoint2D& p, double half_cell) {
  return std::max(0.0, field.distance(p) - half_cell);
}

bool known(const OccupancyGrid& grid, const mrpt::math::TPoint2D& p) {
  const Cell c = grid.cell(p);
  return grid.inside(c) && grid[c] != Occupancy::Unknown;
}

}  // namespace

double wall_half_thickness(const OccupancyGrid& grid) {
  const auto occupied = [&](int x, int y) { return grid.inside({x, y}) && grid[{x, y}] == Occupancy::Occupied; };
  std::size_t area = 0;
  std::size_t straight = 0;
  std::size_t diagonal = 0;
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      if (grid[{x, y}] != Occupancy::Occupied) continue;
      ++area;
      straight += (occupied(x - 1, y) ? 0u : 1u) + (occupied(x + 1, y) ? 0u : 1u) + (occupied(x, y - 1) ? 0u : 1u) +
                  (occupied(x, y + 1) ? 0u : 1u);
      diagonal += (occupied(x - 1, y - 1) ? 0u : 1u) + (occupied(x + 1, y + 1) ? 0u : 1u) +
                  (occupied(x - 1, y + 1) ? 0u : 1u) + (occupied(x + 1, y - 1) ? 0u : 1u);
    }
  }
  if (area == 0) return 0.0;
  const double boundary = kPi / 8.0 * (static_cast<double>(straight) + static_cast<double>(diagonal) / std::sqrt(2.0));
  return grid.resolution() * static_cast<double>(area) / boundary;
}

Overlap overlap(const OccupancyGrid& map, const OccupancyGrid& truth, const mrpt::math::TPose2D& T_truth_map,
                double tau) {
  Overlap out;
  const double excess = wall_half_thickness(map) - wall_half_thickness(truth);
  const double map_excess = std::max(0.0, excess);
  const double truth_excess = std::max(0.0, -excess);
  const WallField to_truth(truth, tau + truth.resolution());
  const WallField to_map(map, tau + map.resolution());

  const Rigid T(T_truth_map);
  double sum = 0.0;
  for (const mrpt::math::TPoint2D& p_map : wall_points(map)) {
    const mrpt::math::TPoint2D p_truth = T.forward(p_map);
    if (!known(truth, p_truth)) continue;
    sum += kernel(to_wall(to_truth, p_truth, 0.5 * truth.resolution()) + truth_excess, tau);
    ++out.map_cells;
  }
  if (out.map_cells > 0) out.precision = sum / static_cast<double>(out.map_cells);

  sum = 0.0;
  for (const mrpt::math::TPoint2D& p_truth : wall_points(truth)) {
    sum += kernel(to_wall(to_map, T.inverse(p_truth), 0.5 * map.resolution()) + map_excess, tau);
    ++out.truth_cells;
  }
  if (out.truth_cells > 0) out.recall = sum / static_cast<double>(out.truth_cells);
  out.score = std::min(out.precision, out.recall);
  return out;
}

}  // namespace rubble::scoring
