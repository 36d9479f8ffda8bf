#include "slam/grid/bit_raster.h"

namespace rubble::slam {

void BitRaster::reset(Cell low, int width, int height) {
  low_ = low;
  width_ = width;
  height_ = height;
  words_per_row_ = (width + 63) / 64;
  words_.assign(static_cast<std::size_t>(words_per_row_) * static_cast<std::size_t>(height), 0);
}

bool BitRaster::test(Cell c) const {
  if (!inside(c)) return false;
  return (row(c.y - low_.y)[(c.x - low_.x) >> 6] & bit(c)) != 0;
}

}  // namespace rubble::slam
