#pragma once

#include <vector>

#include "base/grid.h"

namespace rubble::scoring {

/// So many times as long along a direction [rad] and across it.
struct AxisSizes {
  double direction = 0.0;
  double along = 1.0;
  double across = 1.0;
};

/// Ground that is known [m^2].
double known_m2(const OccupancyGrid& grid);

struct ToldSizes {
  std::vector<double> sizes;         ///< times as large
  std::vector<AxisSizes> stretches;  ///< along its walls and across them by different factors (8 % and more)
};

/// At which sizes, from a fifth to five times, a drawing knows as much ground as another map, or reaches as far along
/// its walls and across them. The outermost hundredth of what is known does not count for its reach: a strip that joins
/// it to something.
ToldSizes sizes_told(const OccupancyGrid& drawing, const OccupancyGrid& other);

/// The drawing turned so that `direction` is that of x, and stretched. No wall is lost where rows fall together; turned
/// by an angle, walls of one cell may have holes of a cell.
OccupancyGrid stretched(const OccupancyGrid& drawing, const AxisSizes& by);

}  // namespace rubble::scoring
