#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "slam/robust/matching/cloud.h"

namespace rubble::slam {

/// A small piece of surface: the mean of the points with about one normal that fell into one cell.
struct Surfel {
  float x = 0.0F, y = 0.0F;
  float nx = 0.0F, ny = 0.0F;
};

/// Surfaces as surfels in a grid of cells; both sides of a thin wall stay apart, for their normals oppose each other.
/// Filled by add() between begin() and finish(), then asked.
class SurfelGrid {
 public:
  /// Covers [low, high] and a metre around it; in larger cells where they would be too many.
  void begin(double cell, const mrpt::math::TPoint2D& low, const mrpt::math::TPoint2D& high);
  /// Adds points seen from T; those without a normal say nothing about a surface and are passed over.
  void add(const std::vector<OrientedPoint>& points, const mrpt::math::TPose2D& T);
  void finish();

  /// The surfel closest to (x, y) within `radius`; with a normal (not both zero) one that looks the same way.
  const Surfel* nearest(float x, float y, float nx, float ny, float radius) const;
  const std::vector<Surfel>& surfels() const { return surfels_; }
  bool empty() const { return surfels_.empty(); }
  /// Every n-th surfel as a point.
  std::vector<OrientedPoint> every_nth(std::size_t n) const;
  /// As many of them, evenly taken, as are not twice `most`.
  std::vector<OrientedPoint> thinned_to(std::size_t most) const;

 private:
  /// A point that was added, in the grid's frame.
  struct Added {
    float x, y, nx, ny;
    std::uint32_t cell;
  };
  struct Sum {
    float x, y, nx, ny;
    float count;
    int next;  ///< in its cell, -1: none
  };
  /// Cells below `cell` that hold something.
  std::size_t rank(std::uint32_t cell) const {
    const std::uint64_t below = (std::uint64_t{1} << (cell & 63U)) - 1U;
    return ranks_[cell >> 6U] + static_cast<std::size_t>(__builtin_popcountll(filled_[cell >> 6U] & below));
  }

  float cells_per_m_ = 10.0F;
  float x0_ = 0.0F, y0_ = 0.0F;
  int width_ = 0, height_ = 0;
  std::vector<Added> added_;           ///< while filling
  std::vector<int> head_;              ///< while filling: newest sum of each cell that holds something, -1: none
  std::vector<Sum> sums_;              ///< while filling
  std::vector<std::uint64_t> filled_;  ///< a bit for each cell that holds something: of many cells few do
  std::vector<std::uint32_t> ranks_;   ///< of the first cell of each word
  std::vector<int> first_;             ///< first surfel of each cell that holds something, and one more
  std::vector<Surfel> surfels_;        ///< row by row: what is near lies near in memory
};

}  // namespace rubble::slam
