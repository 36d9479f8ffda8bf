#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <limits>
#include <vector>

#include "arenas/model/arena.h"
#include "base/grid.h"

namespace rubble::arenas {

/// Finds the floor patches near a place without asking all of them: buckets of one pallet each.
/// Keeps a reference to the arena, whose floor must not change meanwhile.
class PatchIndex {
 public:
  explicit PatchIndex(const Arena& arena);

  /// Patches whose bounding box, 1 mm larger to all sides, touches the box around a and b, in ascending order, each
  /// once.
  std::vector<std::size_t> near(const mrpt::math::TPoint2D& a, const mrpt::math::TPoint2D& b) const;

  /// As floor_height(arena, p).
  double floor_height(const mrpt::math::TPoint2D& p) const;

 private:
  struct Box {
    static constexpr double kInfinity = std::numeric_limits<double>::infinity();
    mrpt::math::TPoint2D low{kInfinity, kInfinity};
    mrpt::math::TPoint2D high{-kInfinity, -kInfinity};
    void include(const mrpt::math::TPoint2D& p);
  };
  static std::vector<Box> boxes_of(const Arena& arena);
  /// Of buckets of one pallet each, or larger ones.
  static GridFrame frame_over(const std::vector<Box>& boxes, double cell_size);
  Cell bucket(const mrpt::math::TPoint2D& p) const;
  /// Calls visit(index of a bucket) for all that the box touches.
  template <class Visit>
  void for_buckets(const Box& box, const Visit& visit) const;

  const Arena& arena_;
  std::vector<Box> boxes_;            ///< of the patches, 1 mm larger to all sides
  GridFrame frame_;                   ///< of the buckets
  std::vector<std::size_t> begins_;   ///< where each bucket begins in entries_, and where the last one ends
  std::vector<std::size_t> entries_;  ///< patches, bucket after bucket, ascending in each
};

}  // namespace rubble::arenas
