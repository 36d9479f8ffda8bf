#include "explore/paper/known_ground.h"

#include <algorithm>

namespace rubble::explore {
namespace {

constexpr double kWorthWhile = 1.0;  ///< [m^2]

std::size_t known_cells(const Traversable& floor) {
  std::size_t known = 0;
  for (int y = 0; y < floor.cells.height(); ++y)
    known += static_cast<std::size_t>(std::count_if(floor.cells.row(y), floor.cells.row(y) + floor.cells.width(),
                                                    [](Occupancy o) { return o != Occupancy::Unknown; }));
  return known;
}

}  // namespace

void KnownGround::mark(const Traversable& floor) { cells_ = known_cells(floor); }

bool KnownGround::grown(const Traversable& floor) const {
  const std::size_t known = known_cells(floor);
  const double cell = floor.frame().resolution;
  return known > cells_ && static_cast<double>(known - cells_) * cell * cell >= kWorthWhile;
}

}  // namespace rubble::explore
