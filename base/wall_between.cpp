#include "base/wall_between.h"

#include "base/planar.h"

namespace rubble {

using mrpt::math::TPoint2D;

bool wall_between(const OccupancyGrid& known, const TPoint2D& from, const TPoint2D& to) {
  const int steps = 1 + static_cast<int>(2.0 * distance(from, to) / known.resolution());
  for (int i = 0; i <= steps; ++i) {
    const Cell c = known.cell(from + (to - from) * (static_cast<double>(i) / steps));
    if (known.inside(c) && known[c] == Occupancy::Occupied) return true;
  }
  return false;
}

}  // namespace rubble
