#include "explore/caution/passed_floor.h"

#include <algorithm>
#include <cmath>

namespace rubble::explore {
namespace {

constexpr double kCell = 0.15;  ///< [m]

int cell_of(double x) { return static_cast<int>(std::floor(x / kCell)); }

}  // namespace

void PassedFloor::add(const mrpt::math::TPoint2D& p_map, double slope) {
  cells_[{cell_of(p_map.x), cell_of(p_map.y)}] = slope;
}

std::optional<double> PassedFloor::slope(const mrpt::math::TPoint2D& p_map) const {
  const int x = cell_of(p_map.x), y = cell_of(p_map.y);
  std::optional<double> steepest;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      if (const auto cell = cells_.find({x + dx, y + dy}); cell != cells_.end())
        steepest = std::max(steepest.value_or(0.0), cell->second);
  return steepest;
}

}  // namespace rubble::explore
