#pragma once

#include <array>
#include <cstdint>

#include "base/grid.h"

namespace rubble::scoring {

/// A number for each class.
class OfClass {
 public:
  std::int64_t& operator[](Occupancy colour) { return values_[static_cast<std::size_t>(colour)]; }
  std::int64_t operator[](Occupancy colour) const { return values_[static_cast<std::size_t>(colour)]; }

 private:
  std::array<std::int64_t, 3> values_{};
};

/// Sums of Manhattan distances [cells] from each cell of one grid to the nearest one of its class in the other.
struct ManhattanSums {
  OfClass map_count;  ///< cells of each class
  OfClass truth_count;
  OfClass map_to_truth;  ///< 0 for a class that one of them lacks
  OfClass truth_to_map;
};

/// Both grids lie on each other: one size, width + height < 65000. Exact, O(cells): min-plus sweeps north, south, east
/// and west; in bytes while no distance that counts exceeds 254 cells, else in words.
ManhattanSums manhattan_sums(const OccupancyGrid& map, const OccupancyGrid& truth);

}  // namespace rubble::scoring
