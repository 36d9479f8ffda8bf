#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>

#include "base/grid.h"

namespace rubble::scoring {

/// How well the walls of two maps lie on each other, k(d) = clip(1 - d / tau, 0, 1).
struct Overlap {
  double precision = 0.0;       ///< mean k over the map's wall cells of the distance to the truth's walls
  double recall = 0.0;          ///< mean k over the truth's wall cells of the distance to the map's walls
  double score = 0.0;           ///< min(precision, recall)
  std::size_t map_cells = 0;    ///< map walls that counted: those the truth knows anything about
  std::size_t truth_cells = 0;  ///< truth walls that counted: all of them
};

/// Distances go to the edge of the wall cell (half a cell less than to its centre). Map walls where the truth is
/// unknown are ignored. All truth walls count, so what the map does not know costs recall.
///
/// Thick walls reach further: without care, fattening every wall of a map would pull up its recall. So the half
/// thickness (area / boundary) by which one map's walls are fatter than the other's is added to the distances to them.
/// No walls in either map: 0.
Overlap overlap(const OccupancyGrid& map, const OccupancyGrid& truth, const mrpt::math::TPose2D& T_truth_map,
                double tau);

/// Mean half thickness of the walls [m]: area over boundary length, the latter by Cauchy-Crofton in four directions so
/// that it does not depend on how the walls lie on the grid (within 5 %).
double wall_half_thickness(const OccupancyGrid& grid);

}  // namespace rubble::scoring
