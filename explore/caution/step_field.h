#pragma once

#include <mrpt/math/TPoint2D.h>

#include <algorithm>
#include <limits>

#include "base/grid.h"
#include "explore/caution/pallet_grid.h"

namespace rubble::explore {

/// A range of numbers.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  double length() const { return high - low; }
  double middle() const { return 0.5 * (low + high); }
};

/// The box around cells along the edges of the pallets [pallets].
struct Extent {
  Range x, y;
  void add(const mrpt::math::TPoint2D& p_grid) {
    x.add(p_grid.x);
    y.add(p_grid.y);
  }
};

/// Whether what the map shows well inside a pallet is spread over most of it both ways, as the higher steps of a red
/// field are from corner to corner.
bool shows_step_field(const OccupancyGrid& cells, const PalletGrid& grid, Cell pallet);

}  // namespace rubble::explore
