#include "explore/caution/passed_floor.h"

#include <cmath>

namespace rubble::explore {
namespace {

constexpr double kCell = 0.15;  ///< [m]

int cell_of(double x) { return static_cast<int>(std::floor(x / kCell)); }

}  // namespace

void PassedFloor::add(const mrpt::math::TPoint2D& p_map) { cells_.insert({cell_of(p_map.x), cell_of(p_map.y)}); }

bool PassedFloor::holds(const mrpt::math::TPoint2D& p_map) const {
  const int x = cell_of(p_map.x), y = cell_of(p_map.y);
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      if (cells_.count({x + dx, y + dy}) != 0) return true;
  return false;
}

}  // namespace rubble::explore
