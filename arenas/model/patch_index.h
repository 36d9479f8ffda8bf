#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <vector>

#include "arenas/model/arena.h"
#include "base/grid.h"

namespace rubble::arenas {

/// Finds the floor patches near a place without asking all of them: buckets of one pallet each.
/// Keeps a reference to the arena, whose floor must not change meanwhile.
class PatchIndex {
 public:
  explicit PatchIndex(const Arena& arena);

  /// Patches whose bounding box may touch the box around a and b, in ascending order, each once.
  std::vector<std::size_t> near(const mrpt::math::TPoint2D& a, const mrpt::math::TPoint2D& b) const;

  /// As floor_height(arena, p).
  double floor_height(const mrpt::math::TPoint2D& p) const;

 private:
  Cell bucket(const mrpt::math::TPoint2D& p) const;

  const Arena& arena_;
  Grid<std::vector<std::size_t>> buckets_;
};

}  // namespace rubble::arenas
