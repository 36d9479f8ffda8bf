#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/grid.h"

namespace rubble::scoring {

/// Which of the two grids a cell is taken from.
enum class Layer : unsigned char { Map = 0, Truth = 1 };

/// Sums of Manhattan distances between the cells of one class of two grids, which lie on each other.
class ManhattanSum {
 public:
  /// Both of one size, width + height < 65000.
  ManhattanSum(const OccupancyGrid& map, const OccupancyGrid& truth);

  /// Number of cells of `colour`.
  std::int64_t count(Layer layer, Occupancy colour) const;

  /// Sum of the distances [cells] from each cell of `colour` in layer `from` to the nearest one in the other layer,
  /// which must have one. Exact, O(cells): two min-plus sweeps down the columns, a transpose, two along the rows; in
  /// bytes while no distance that counts exceeds 254, else in 16 bits.
  std::int64_t from(Layer from, Occupancy colour);

 private:
  int width_;                                           ///< padded to whole blocks [cells]
  int height_;                                          ///< the same
  std::vector<std::uint8_t> rows_;                      ///< both classes of each cell, row-major
  std::vector<std::uint8_t> columns_;                   ///< the same, transposed
  std::array<std::array<std::int64_t, 3>, 2> count_{};  ///< cells of each layer and class
  std::vector<std::uint8_t> bytes_;                     ///< steps; kept, as fresh pages cost more than the sweeps
  std::vector<std::uint16_t> words_;                    ///< the same in 16 bits, where bytes do not reach
};

}  // namespace rubble::scoring
