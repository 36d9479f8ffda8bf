#include "arenas/model/patch_index.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arenas/model/geometry.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

constexpr double kSlack = 1e-3;  ///< patches are entered this much larger, so that their edges belong to them [m]

struct Box {
  TPoint2D low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  TPoint2D high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  void include(const TPoint2D& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
};

Box box_of(const Outline& outline) {
  Box box;
  for (const TPoint2D& p : outline) box.include(p);
  return box;
}

GridFrame frame_over(const Arena& arena) {
  Box all;
  for (const FloorPatch& patch : arena.floor) {
    for (const TPoint2D& p : patch.outline) all.include(p);
  }
  if (arena.floor.empty()) return {1, 1, 1.0, 0.0, 0.0};
  constexpr double kMostBuckets = 1000.0;  // a side: an arena of any size stays in memory
  const double edge =
      std::max({arena.cell_size, (all.high.x - all.low.x) / kMostBuckets, (all.high.y - all.low.y) / kMostBuckets});
  return {static_cast<int>((all.high.x - all.low.x) / edge) + 1, static_cast<int>((all.high.y - all.low.y) / edge) + 1,
          edge, all.low.x, all.low.y};
}

}  // namespace

PatchIndex::PatchIndex(const Arena& arena) : arena_(arena), buckets_(frame_over(arena)) {
  for (std::size_t i = 0; i < arena.floor.size(); ++i) {
    const Box box = box_of(arena.floor[i].outline);
    const Cell low = bucket(box.low - TPoint2D{kSlack, kSlack});
    const Cell high = bucket(box.high + TPoint2D{kSlack, kSlack});
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) buckets_[{x, y}].push_back(i);
    }
  }
}

Cell PatchIndex::bucket(const TPoint2D& p) const {
  const Cell c = buckets_.cell(p);
  return {std::clamp(c.x, 0, buckets_.width() - 1), std::clamp(c.y, 0, buckets_.height() - 1)};
}

std::vector<std::size_t> PatchIndex::near(const TPoint2D& a, const TPoint2D& b) const {
  const Cell low = bucket({std::min(a.x, b.x), std::min(a.y, b.y)});
  const Cell high = bucket({std::max(a.x, b.x), std::max(a.y, b.y)});
  std::vector<std::size_t> found;
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) {
      const std::vector<std::size_t>& bucket = buckets_[{x, y}];
      found.insert(found.end(), bucket.begin(), bucket.end());
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

double PatchIndex::floor_height(const TPoint2D& p) const {
  double height = -std::numeric_limits<double>::infinity();
  for (const std::size_t i : buckets_[bucket(p)]) {
    const FloorPatch& patch = arena_.floor[i];
    if (contains(patch.outline, p)) height = std::max(height, patch.height(p));
  }
  return height;
}

}  // namespace rubble::arenas
