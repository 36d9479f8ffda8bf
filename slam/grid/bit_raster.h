#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/grid.h"

namespace rubble::slam {

/// A window of grid cells with one bit each, 64 cells of a row in a word.
class BitRaster {
 public:
  /// Covers `width` x `height` cells from `low` on; all bits are cleared. Reuses its memory.
  void reset(Cell low, int width, int height);

  Cell low() const { return low_; }
  int width() const { return width_; }
  int height() const { return height_; }
  int words_per_row() const { return words_per_row_; }
  /// Row `y` of the window (0: low().y); bit b of word w is the cell at low().x + 64 w + b.
  const std::uint64_t* row(int y) const { return words_.data() + offset(y); }
  std::uint64_t* row(int y) { return words_.data() + offset(y); }

  /// Of a cell in grid coordinates; cells outside the window are false.
  bool test(Cell c) const;
  /// The cell must lie in the window.
  void set(Cell c) { word(c) |= bit(c); }
  void clear(Cell c) { word(c) &= ~bit(c); }
  bool inside(Cell c) const {
    return c.x >= low_.x && c.y >= low_.y && c.x < low_.x + width_ && c.y < low_.y + height_;
  }

 private:
  std::size_t offset(int y) const { return static_cast<std::size_t>(y) * static_cast<std::size_t>(words_per_row_); }
  std::uint64_t& word(Cell c) { return row(c.y - low_.y)[(c.x - low_.x) >> 6]; }
  std::uint64_t bit(Cell c) const { return std::uint64_t{1} << ((c.x - low_.x) & 63); }

  Cell low_;
  int width_ = 0;
  int height_ = 0;
  int words_per_row_ = 0;
  std::vector<std::uint64_t> words_;
};

}  // namespace rubble::slam
