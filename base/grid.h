#pragma once

#include <mrpt/math/TPoint2D.h>

#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

namespace rubble {

/// Index of a grid cell: x to the east (column), y to the north (row).
struct Cell {
  int x = 0;
  int y = 0;
  friend constexpr bool operator==(Cell a, Cell b) { return a.x == b.x && a.y == b.y; }
  friend constexpr bool operator!=(Cell a, Cell b) { return !(a == b); }
};

/// The neighbours of a cell across its edges, by quarter turns counter-clockwise from east.
inline constexpr std::array<Cell, 4> kCellSides{Cell{1, 0}, Cell{0, 1}, Cell{-1, 0}, Cell{0, -1}};
/// The same by quarter turns clockwise from north, 0 to 3.
constexpr Cell clockwise_side(std::size_t turns) { return kCellSides[(5 - turns) % 4]; }

/// Where a raster lies in the metric plane. Row 0 is the southernmost; images flip rows when they are written.
struct GridFrame {
  int width = 0;             ///< [cells]
  int height = 0;            ///< [cells]
  double resolution = 0.05;  ///< edge of a cell [m]
  double x0 = 0.0;           ///< west edge of column 0 [m]
  double y0 = 0.0;           ///< south edge of row 0 [m]

  std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  bool inside(Cell c) const { return c.x >= 0 && c.y >= 0 && c.x < width && c.y < height; }
  std::size_t index(Cell c) const {
    return static_cast<std::size_t>(c.y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(c.x);
  }
  /// The cell that holds p; may lie outside the grid.
  Cell cell(const mrpt::math::TPoint2D& p) const {
    return {static_cast<int>(std::floor((p.x - x0) / resolution)),
            static_cast<int>(std::floor((p.y - y0) / resolution))};
  }
  mrpt::math::TPoint2D centre(Cell c) const {
    return {x0 + (static_cast<double>(c.x) + 0.5) * resolution, y0 + (static_cast<double>(c.y) + 0.5) * resolution};
  }
  friend bool operator==(const GridFrame& a, const GridFrame& b) {
    return a.width == b.width && a.height == b.height && a.resolution == b.resolution && a.x0 == b.x0 && a.y0 == b.y0;
  }
  friend bool operator!=(const GridFrame& a, const GridFrame& b) { return !(a == b); }
};

/// A metric raster of T, row-major from the south-west corner.
template <class T>
class Grid {
 public:
  Grid() = default;
  explicit Grid(const GridFrame& frame, const T& value = T{}) : frame_(frame), cells_(frame.size(), value) {}

  const GridFrame& frame() const { return frame_; }
  int width() const { return frame_.width; }
  int height() const { return frame_.height; }
  double resolution() const { return frame_.resolution; }
  bool inside(Cell c) const { return frame_.inside(c); }
  Cell cell(const mrpt::math::TPoint2D& p) const { return frame_.cell(p); }
  mrpt::math::TPoint2D centre(Cell c) const { return frame_.centre(c); }

  T& operator[](Cell c) {
    assert(inside(c));
    return cells_[frame_.index(c)];
  }
  const T& operator[](Cell c) const {
    assert(inside(c));
    return cells_[frame_.index(c)];
  }
  T* data() { return cells_.data(); }
  const T* data() const { return cells_.data(); }
  T* row(int y) { return cells_.data() + frame_.index({0, y}); }
  const T* row(int y) const { return cells_.data() + frame_.index({0, y}); }
  std::vector<T>& cells() { return cells_; }
  const std::vector<T>& cells() const { return cells_; }

 private:
  GridFrame frame_;
  std::vector<T> cells_;
};

/// The same cells elsewhere or of another size; `frame` has as many.
template <class T>
Grid<T> with_frame(const Grid<T>& grid, const GridFrame& frame) {
  assert(frame.width == grid.width() && frame.height == grid.height());
  Grid<T> out(frame);
  out.cells() = grid.cells();
  return out;
}

/// What a map says about a cell.
enum class Occupancy : unsigned char { Unknown = 0, Free = 1, Occupied = 2 };
using OccupancyGrid = Grid<Occupancy>;

/// Of the cell at p; unknown beyond the map.
inline Occupancy occupancy_at(const OccupancyGrid& grid, const mrpt::math::TPoint2D& p) {
  const Cell c = grid.cell(p);
  return grid.inside(c) ? grid[c] : Occupancy::Unknown;
}

}  // namespace rubble
