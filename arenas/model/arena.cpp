#include "arenas/model/arena.h"

#include <algorithm>
#include <limits>

#include "arenas/model/geometry.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

void include(Arena& arena, const TPoint2D& p, double radius = 0.0) {
  arena.min_corner.x = std::min(arena.min_corner.x, p.x - radius);
  arena.min_corner.y = std::min(arena.min_corner.y, p.y - radius);
  arena.max_corner.x = std::max(arena.max_corner.x, p.x + radius);
  arena.max_corner.y = std::max(arena.max_corner.y, p.y + radius);
}

void include(Arena& arena, const Outline& outline) {
  for (const TPoint2D& p : outline) include(arena, p);
}

}  // namespace

const std::vector<std::string>& object_kinds() {
  static const std::vector<std::string> names = {"bottle", "radio"};
  return names;
}

void set_bounds(Arena& arena) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  arena.min_corner = {kInfinity, kInfinity};
  arena.max_corner = {-kInfinity, -kInfinity};
  for (const FloorPatch& patch : arena.floor) include(arena, patch.outline);
  for (const Solid& solid : arena.solids) include(arena, solid.outline);
  for (const PaperSheet& sheet : arena.sheets) include(arena, sheet.outline);
  for (const PaperBall& ball : arena.balls) include(arena, ball.position, ball.radius);
  for (const LooseObject& object : arena.objects) include(arena, object.position, object.radius);
  for (const Victim& victim : arena.victims) include(arena, {victim.position.x, victim.position.y});
}

double floor_height(const Arena& arena, const TPoint2D& p) {
  double height = -std::numeric_limits<double>::infinity();
  for (const FloorPatch& patch : arena.floor) {
    if (contains(patch.outline, p)) height = std::max(height, patch.height(p));
  }
  return height;
}

}  // namespace rubble::arenas
