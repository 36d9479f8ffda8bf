#pragma once

#include <mrpt/math/TPoint2D.h>

#include <vector>

#include "base/grid.h"
#include "explore/plan/traversable.h"

namespace rubble::explore {

/// Frontier cells that touch each other (8 neighbours).
struct FrontierCluster {
  std::vector<Cell> cells;
  mrpt::math::TPoint2D centroid;  ///< [m]
};

/// All frontier cells: seen free, with an unseen 4-neighbour (Yamauchi 1997). In raster order.
std::vector<Cell> frontier_cells(const Traversable& floor);

/// Frontier cells as clusters of at least `min_cells`, in raster order of their first cell.
std::vector<FrontierCluster> frontier_clusters(const Traversable& floor, int min_cells);

}  // namespace rubble::explore
