#include "arenas/elements/victim_box.h"

#include <algorithm>
#include <cmath>

#include "arenas/model/geometry.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

constexpr double kBoard = 0.015;  ///< [m]

double floor_or_ground(const Arena& arena, const TPoint2D& p) {
  const double z = floor_height(arena, p);
  return std::isfinite(z) ? z : 0.0;
}

}  // namespace

void add_victim(Arena& arena, Victim victim, double size) {
  const TPoint2D centre{victim.position.x, victim.position.y};
  victim.position.z += floor_or_ground(arena, centre);
  arena.victims.push_back(victim);
  if (size <= 0.0) return;

  double lowest = floor_or_ground(arena, centre);
  double highest = lowest;
  for (const TPoint2D& corner : rectangle(centre, size, size, victim.facing)) {
    const double z = floor_or_ground(arena, corner);
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  }
  const TPoint2D forward{std::cos(victim.facing), std::sin(victim.facing)};
  const TPoint2D left{-forward.y, forward.x};
  const double aside = 0.5 * (size - kBoard);
  const auto add_board = [&](const TPoint2D& middle, double length, double width) {
    arena.solids.push_back({rectangle(middle, length, width, victim.facing), lowest, highest + size, "victim_box"});
  };
  add_board(centre - forward * aside, kBoard, size);
  add_board(centre + left * aside, size, kBoard);
  add_board(centre - left * aside, size, kBoard);
}

}  // namespace rubble::arenas
