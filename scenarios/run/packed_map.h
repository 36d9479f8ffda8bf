#pragma once

#include <cstdint>
#include <vector>

#include "base/grid.h"

namespace rubble::scenarios {

/// A map that is kept for later beside many others: a byte for up to 64 cells of a kind that follow each other.
class PackedMap {
 public:
  PackedMap() = default;
  PackedMap(const OccupancyGrid& map);

  OccupancyGrid unpacked() const;
  const GridFrame& frame() const { return frame_; }
  std::size_t bytes() const { return runs_.size(); }

 private:
  GridFrame frame_;
  std::vector<std::uint8_t> runs_;  ///< kind in the upper two bits, length less one below
};

}  // namespace rubble::scenarios
