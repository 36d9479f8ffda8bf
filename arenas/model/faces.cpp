#include <algorithm>
#include <cmath>
#include <limits>

#include "arenas/model/arena.h"
#include "arenas/model/patch_index.h"
#include "arenas/model/risers.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPoint3D;

constexpr double kFlush = 1e-9;  ///< the two ends of a riser's gap are one vertex below this [m]

TPoint3D lift(const TPoint2D& p, double z) { return {p.x, p.y, z}; }

Face face_of(const FloorPatch& patch) {
  Face face;
  for (const TPoint2D& p : patch.outline) face.vertices.push_back(lift(p, patch.height(p)));
  return face;
}

Face face_of(const Riser& riser) {
  Face face;
  face.vertices.push_back(lift(riser.a, riser.low_a));
  face.vertices.push_back(lift(riser.b, riser.low_b));
  if (riser.high_b - riser.low_b > kFlush) face.vertices.push_back(lift(riser.b, riser.high_b));
  if (riser.high_a - riser.low_a > kFlush) face.vertices.push_back(lift(riser.a, riser.high_a));
  return face;
}

/// Whether light gets under the solid: it hangs, or stands across a step.
bool shows_bottom(const PatchIndex& floor, const Solid& solid) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const TPoint2D& p : solid.outline) {
    const double z = floor.floor_height(p);
    lowest = std::min(lowest, std::isfinite(z) ? z : 0.0);
  }
  return solid.z_bottom > lowest + 1e-3;
}

}  // namespace

void add_prism(const Outline& outline, double bottom, double top, std::vector<Face>& faces, bool with_bottom) {
  Face lid;
  Face base;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const TPoint2D& a = outline[i];
    const TPoint2D& b = outline[(i + 1) % outline.size()];
    faces.push_back({{lift(a, bottom), lift(b, bottom), lift(b, top), lift(a, top)}});
    lid.vertices.push_back(lift(a, top));
    base.vertices.push_back(lift(a, bottom));
  }
  faces.push_back(lid);
  if (!with_bottom) return;
  std::reverse(base.vertices.begin(), base.vertices.end());  // seen from below
  faces.push_back(base);
}

std::vector<Face> faces(const Arena& arena) {
  std::vector<Face> result;
  for (const FloorPatch& patch : arena.floor) result.push_back(face_of(patch));
  for (const Riser& riser : risers(arena)) result.push_back(face_of(riser));
  const PatchIndex floor(arena);
  for (const Solid& solid : arena.solids) {
    add_prism(solid.outline, solid.z_bottom, solid.z_top, result, shows_bottom(floor, solid));
  }
  return result;
}

}  // namespace rubble::arenas
