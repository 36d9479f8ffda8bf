#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/grid.h"
#include "base/large_pages.h"

namespace rubble::slam {

/// The counts of a map's cells in squares that take memory only where something was counted: a map that grows moves
/// their addresses, never a count.
class CountTiles {
 public:
  static constexpr int kSide = 64;                                   ///< cells along an edge
  static constexpr std::size_t kCells = std::size_t{kSide} * kSide;  ///< row-major from the south-west

  struct Tile {
    std::array<std::uint16_t, kCells> seen;
    std::array<std::uint16_t, kCells> occupied;
    std::array<std::uint8_t, kCells> p_occ;  ///< [1/255]
  };

  /// Where the counts of a cell lie in its tile.
  static std::size_t place(Cell c) {
    return static_cast<std::size_t>((c.y & (kSide - 1)) * kSide + (c.x & (kSide - 1)));
  }

  /// Of `width` x `height` cells, nothing counted. Memory for as many tiles, up to a slab, is at hand from the start.
  CountTiles(int width, int height);
  CountTiles(const CountTiles& other);
  CountTiles& operator=(const CountTiles& other);
  CountTiles(CountTiles&& other) noexcept { swap(other); }
  CountTiles& operator=(CountTiles&& other) noexcept {
    swap(other);
    return *this;
  }
  ~CountTiles() = default;

  /// Tiles in a row of them.
  int across() const { return across_; }
  /// The tile of a cell (not below zero), zeros where nothing was counted.
  const Tile& of(Cell c) const { return *shown_[number(c)]; }
  /// Null where nothing was counted.
  const Tile* counted(Cell c) const { return tiles_[number(c)]; }
  /// To count in.
  Tile& at(Cell c) {
    Tile* const tile = tiles_[number(c)];
    return tile != nullptr ? *tile : open(number(c));
  }
  /// All of them as of() has them, row by row from the south-west.
  const Tile* const* all() const { return shown_.data(); }

  /// Nothing counted, and of another size.
  void clear(int width, int height);
  /// Cells (x, y) are now (x + dx, y + dy) of `width` x `height`; both steps are multiples of kSide, not below zero.
  void grow(int dx, int dy, int width, int height);

 private:
  std::size_t number(Cell c) const {
    return static_cast<std::size_t>(c.y / kSide) * static_cast<std::size_t>(across_) +
           static_cast<std::size_t>(c.x / kSide);
  }
  Tile& open(std::size_t number);
  void take_slab(std::size_t tiles);
  void swap(CountTiles& other) noexcept;
  void lay_out(int width, int height);

  int across_ = 0;
  int down_ = 0;
  std::vector<Tile*> tiles_;
  std::vector<const Tile*> shown_;  ///< the same with a tile of zeros where nothing was counted
  std::vector<LargeBuffer> slabs_;  ///< where tiles lie
  std::size_t slab_ = 0;            ///< tiles of the last slab ...
  std::size_t left_ = 0;            ///< ... of which so many were never given out
  std::vector<Tile*> given_back_;
};

}  // namespace rubble::slam
