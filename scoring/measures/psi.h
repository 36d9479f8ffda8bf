#pragma once

#include <array>

#include "base/grid.h"

namespace rubble::scoring {

/// Eq. (6) for one class in both directions [m].
struct PsiClass {
  double map_to_truth = 0.0;
  double truth_to_map = 0.0;
};

/// The image similarity of Varsandan and Birk, eqs. (5) and (6), in metres. Zero for equal images; smaller is better.
struct Psi {
  PsiClass occupied;
  PsiClass free;
  PsiClass unknown;      ///< grows and shrinks with the canvas: never compare it between canvases
  double literal = 0.0;  ///< eq. (5): the sum over the three classes and both directions
  double mean = 0.0;     ///< mean over {occupied, free} and both directions
};

/// Both grids on one frame (same size and resolution). A class neither grid has counts 0; one that only one grid has
/// counts `absent_cap` [m] in both directions, because eq. (6) has no value there. O(cells).
Psi psi(const OccupancyGrid& map, const OccupancyGrid& truth, double absent_cap);

}  // namespace rubble::scoring
