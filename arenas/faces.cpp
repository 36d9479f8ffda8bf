#include <algorithm>
#include <cmath>
#include <limits>

#include "arenas/arena.h"
#include "arenas/patch_index.h"
#include "arenas/risers.h"

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

void add_faces(const Solid& solid, bool with_bottom, std::vector<Face>& faces) {
  Face top;
  Face bottom;
  for (std::size_t i = 0; i < solid.outline.size(); ++i) {
    const TPoint2D& a = solid.outline[i];
    const TPoint2D& b = solid.outline[(i + 1) % solid.outline.size()];
    faces.push_back({{lift(a, solid.z_bottom), lift(b, solid.z_bottom), lift(b, solid.z_top), lift(a, solid.z_top)}});
    top.vertices.push_back(lift(a, solid.z_top));
    bottom.vertices.push_back(lift(a, solid.z_bottom));
  }
  faces.push_back(top);
  if (!with_bottom) return;
  std::reverse(bottom.vertices.begin(), bottom.vertices.end());  // seen from below
  faces.push_back(bottom);
}

}  // namespace

std::vector<Face> faces(const Arena& arena) {
  std::vector<Face> result;
  for (const FloorPatch& patch : arena.floor) result.push_back(face_of(patch));
  for (const Riser& riser : risers(arena)) result.push_back(face_of(riser));
  const PatchIndex floor(arena);
  for (const Solid& solid : arena.solids) add_faces(solid, shows_bottom(floor, solid), result);
  return result;
}

}  // namespace rubble::arenas
