#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <vector>

#include "slam/robust/cloud.h"

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
  /// Covers [low, high] and a metre around it.
  void begin(double cell, const mrpt::math::TPoint2D& low, const mrpt::math::TPoint2D& high);
  /// Adds points seen from T; those without a normal say nothing about a surface and are passed over.
  void add(const std::vector<OrientedPoint>& points, const mrpt::math::TPose2D& T);
  void finish();

  /// The surfel closest to (x, y) within `radius`; with a normal (not both zero) one that looks the same way.
  const Surfel* nearest(float x, float y, float nx, float ny, float radius) const;
  const std::vector<Surfel>& surfels() const { return surfels_; }
  bool empty() const { return surfels_.empty(); }

 private:
  struct Sum {
    float x, y, nx, ny;
    float count;
  };
  void put(float x, float y, float nx, float ny);

  float cells_per_m_ = 10.0F;
  float x0_ = 0.0F, y0_ = 0.0F;
  int width_ = 0, height_ = 0;
  std::vector<int> head_;        ///< while filling: newest sum of each cell, -1: none
  std::vector<int> next_;        ///< of each sum: the next in its cell, -1: none
  std::vector<Sum> sums_;        ///< while filling
  std::vector<int> first_;       ///< first surfel of each cell; one more than there are cells
  std::vector<Surfel> surfels_;  ///< row by row: what is near lies near in memory
};

}  // namespace rubble::slam
