#include "arenas/model/rims.h"

#include <algorithm>
#include <cmath>

#include "arenas/model/geometry.h"
#include "arenas/model/patch_index.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

constexpr double kOutward = 1e-4;  ///< how far outside the edge a floor is looked for [m]
constexpr double kMeet = 1e-6;     ///< pieces of an edge that end so near to each other meet

/// What is left of the edge when `covered` is taken out of it.
std::vector<Interval> rest_of(std::vector<Interval> covered) {
  std::sort(covered.begin(), covered.end(), [](const Interval& p, const Interval& q) { return p.from < q.from; });
  std::vector<Interval> rest;
  double from = 0.0;
  for (const Interval& piece : covered) {
    if (piece.from > from + kMeet) rest.push_back({from, piece.from});
    from = std::max(from, piece.to);
  }
  if (from < 1.0 - kMeet) rest.push_back({from, 1.0});
  return rest;
}

/// Where floors go on beyond the edge a -> b of a patch.
std::vector<Interval> floors_beyond(const Arena& arena, const PatchIndex& index, std::size_t own, const TPoint2D& a,
                                    const TPoint2D& b) {
  std::vector<Interval> found;
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  const TPoint2D out{(b.y - a.y) / length * kOutward, -(b.x - a.x) / length * kOutward};
  for (const std::size_t i : index.near(a + out, b + out)) {
    if (i == own) continue;
    if (const auto part = clip(arena.floor[i].outline, a + out, b + out)) found.push_back(*part);
  }
  return found;
}

/// Where solids that reach `level` [m] stand on it.
void add_walls(const Arena& arena, const TPoint2D& a, const TPoint2D& b, double level, std::vector<Interval>& found) {
  for (const Solid& solid : arena.solids) {
    if (solid.gives_way || solid.z_top < level || solid.z_bottom > level) continue;
    if (const auto part = clip(solid.outline, a, b)) found.push_back(*part);
  }
}

}  // namespace

std::vector<Rim> open_rims(const Arena& arena, double climbable_step, double narrowest, double height) {
  const PatchIndex index(arena);
  std::vector<Rim> rims;
  for (std::size_t i = 0; i < arena.floor.size(); ++i) {
    const FloorPatch& patch = arena.floor[i];
    for (std::size_t k = 0; k < patch.outline.size(); ++k) {
      const TPoint2D& a = patch.outline[k];
      const TPoint2D& b = patch.outline[(k + 1) % patch.outline.size()];
      const TPoint2D along = b - a;
      const double length = std::hypot(along.x, along.y);
      if (length < narrowest) continue;
      std::vector<Interval> covered = floors_beyond(arena, index, i, a, b);
      if (rest_of(covered).empty()) continue;
      add_walls(arena, a, b, std::min(patch.height(a), patch.height(b)) + height, covered);
      for (const Interval& piece : rest_of(covered)) {
        const TPoint2D from = a + along * piece.from;
        const TPoint2D to = a + along * piece.to;
        const Rim rim{from, to, patch.height(from), patch.height(to)};
        if (length * (piece.to - piece.from) < narrowest || std::max(rim.z_a, rim.z_b) > climbable_step) continue;
        rims.push_back(rim);
      }
    }
  }
  return rims;
}

}  // namespace rubble::arenas
