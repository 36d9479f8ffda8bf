#include "arenas/model/patch_index.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "arenas/model/geometry.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

constexpr double kSlack = 1e-3;  ///< patches are entered this much larger, so that their edges belong to them [m]

}  // namespace

void PatchIndex::Box::include(const TPoint2D& p) {
  low = {std::min(low.x, p.x), std::min(low.y, p.y)};
  high = {std::max(high.x, p.x), std::max(high.y, p.y)};
}

std::vector<PatchIndex::Box> PatchIndex::boxes_of(const Arena& arena) {
  std::vector<Box> boxes(arena.floor.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (const TPoint2D& p : arena.floor[i].outline) boxes[i].include(p);
    boxes[i].low -= TPoint2D{kSlack, kSlack};
    boxes[i].high += TPoint2D{kSlack, kSlack};
  }
  return boxes;
}

GridFrame PatchIndex::frame_over(const std::vector<Box>& boxes, double cell_size) {
  if (boxes.empty()) return {1, 1, 1.0, 0.0, 0.0};
  Box all;
  for (const Box& box : boxes) {
    all.include(box.low);
    all.include(box.high);
  }
  constexpr double kMostBuckets = 1000.0;  // a side: an arena of any size stays in memory
  const TPoint2D size = all.high - all.low;
  const double edge = std::max({cell_size, size.x / kMostBuckets, size.y / kMostBuckets});
  return {static_cast<int>(size.x / edge) + 1, static_cast<int>(size.y / edge) + 1, edge, all.low.x, all.low.y};
}

template <class Visit>
void PatchIndex::for_buckets(const Box& box, const Visit& visit) const {
  const Cell low = bucket(box.low);
  const Cell high = bucket(box.high);
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) visit(frame_.index({x, y}));
}

PatchIndex::PatchIndex(const Arena& arena)
    : arena_(arena),
      boxes_(boxes_of(arena)),
      frame_(frame_over(boxes_, arena.cell_size)),
      begins_(frame_.size() + 1, 0) {
  for (const Box& box : boxes_) for_buckets(box, [&](std::size_t b) { ++begins_[b + 1]; });
  std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
  entries_.resize(begins_.back());
  std::vector<std::size_t> ends(begins_.begin(), begins_.end() - 1);
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    for_buckets(boxes_[i], [&](std::size_t b) { entries_[ends[b]++] = i; });
}

Cell PatchIndex::bucket(const TPoint2D& p) const {
  const Cell c = frame_.cell(p);
  return {std::clamp(c.x, 0, frame_.width - 1), std::clamp(c.y, 0, frame_.height - 1)};
}

std::vector<std::size_t> PatchIndex::near(const TPoint2D& a, const TPoint2D& b) const {
  Box asked;
  asked.include(a);
  asked.include(b);
  std::vector<std::size_t> found;
  for_buckets(asked, [&](std::size_t bucket) {
    for (std::size_t k = begins_[bucket]; k < begins_[bucket + 1]; ++k) {
      const Box& box = boxes_[entries_[k]];
      if (box.low.x <= asked.high.x && box.high.x >= asked.low.x && box.low.y <= asked.high.y &&
          box.high.y >= asked.low.y)
        found.push_back(entries_[k]);
    }
  });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

double PatchIndex::floor_height(const TPoint2D& p) const {
  double height = -std::numeric_limits<double>::infinity();
  const std::size_t b = frame_.index(bucket(p));
  for (std::size_t k = begins_[b]; k < begins_[b + 1]; ++k) {
    const FloorPatch& patch = arena_.floor[entries_[k]];
    if (contains(patch.outline, p)) height = std::max(height, patch.height(p));
  }
  return height;
}

}  // namespace rubble::arenas
