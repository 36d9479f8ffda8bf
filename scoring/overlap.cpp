#include "scoring/overlap.h"

#include <algorithm>

#include "scoring/wall_field.h"

namespace rubble::scoring {
namespace {

double kernel(double distance, double tau) { return std::clamp(1.0 - distance / tau, 0.0, 1.0); }

bool known(const OccupancyGrid& grid, const mrpt::math::TPoint2D& p) {
  const Cell c = grid.cell(p);
  return grid.inside(c) && grid[c] != Occupancy::Unknown;
}

}  // namespace

double wall_half_thickness(const OccupancyGrid& grid) {
  std::size_t area = 0;
  std::size_t edges = 0;
  const auto occupied = [&](int x, int y) { return grid.inside({x, y}) && grid[{x, y}] == Occupancy::Occupied; };
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      if (grid[{x, y}] != Occupancy::Occupied) continue;
      ++area;
      edges += (occupied(x - 1, y) ? 0u : 1u) + (occupied(x + 1, y) ? 0u : 1u) + (occupied(x, y - 1) ? 0u : 1u) +
               (occupied(x, y + 1) ? 0u : 1u);
    }
  }
  if (edges == 0) return 0.0;
  return grid.resolution() * static_cast<double>(area) / static_cast<double>(edges);
}

Overlap overlap(const OccupancyGrid& map, const OccupancyGrid& truth, const mrpt::math::TPose2D& T_truth_map,
                double tau) {
  Overlap out;
  const double excess = wall_half_thickness(map) - wall_half_thickness(truth);
  const double map_excess = std::max(0.0, excess);
  const double truth_excess = std::max(0.0, -excess);
  const WallField to_truth(truth, tau);
  const WallField to_map(map, tau);

  double sum = 0.0;
  for (const mrpt::math::TPoint2D& p_map : wall_points(map)) {
    const mrpt::math::TPoint2D p_truth = T_truth_map.composePoint(p_map);
    if (!known(truth, p_truth)) continue;
    sum += kernel(to_truth.distance(p_truth) + truth_excess, tau);
    ++out.map_cells;
  }
  if (out.map_cells > 0) out.precision = sum / static_cast<double>(out.map_cells);

  sum = 0.0;
  for (const mrpt::math::TPoint2D& p_truth : wall_points(truth)) {
    sum += kernel(to_map.distance(T_truth_map.inverseComposePoint(p_truth)) + map_excess, tau);
    ++out.truth_cells;
  }
  if (out.truth_cells > 0) out.recall = sum / static_cast<double>(out.truth_cells);
  out.score = std::min(out.precision, out.recall);
  return out;
}

}  // namespace rubble::scoring
