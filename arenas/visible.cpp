#include "arenas/visible.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "arenas/patch_index.h"
#include "arenas/raster.h"
#include "arenas/risers.h"
#include "base/angle.h"
#include "base/distance_transform.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;
using Mask = Grid<std::uint8_t>;

constexpr double kThin = 1e-4;  ///< thickness given to an edge [m]
constexpr double kPoses = 0.4;  ///< distance between the poses looked from [m]
constexpr double kFull = 8.0;   ///< up to here neighbouring rays end in neighbouring cells [m]

/// Cells with something the body cannot pass: solids at its height, and steps too high to climb.
Mask barriers(const Arena& arena, const GridFrame& frame, const Viewer& viewer) {
  Mask mask(frame);
  const PatchIndex floor(arena);
  for (const Solid& solid : arena.solids) {
    if (solid.gives_way) continue;
    for_cells_crossed(frame, solid.outline, [&](Cell c) {
      const double z = floor.floor_height(frame.centre(c));
      const double ground = std::isfinite(z) ? z : 0.0;
      if (solid.z_top > ground + viewer.climbable_step && solid.z_bottom < ground + viewer.height) mask[c] = 1;
    });
  }
  for (const Riser& riser : risers(arena, viewer.climbable_step)) {
    const TPoint2D along = riser.b - riser.a;
    if (std::hypot(along.x, along.y) < kThin) continue;
    for_cells_crossed(frame, strip(riser.a, riser.b, kThin), [&](Cell c) { mask[c] = 1; });
  }
  return mask;
}

/// Marks what one ray sees: a walk from cell to cell (Amanatides and Woo 1987).
void look(const OccupancyGrid& truth, Cell from, double bearing, double range, Mask& seen) {
  const double dx = std::cos(bearing);
  const double dy = std::sin(bearing);
  const double step_x = 1.0 / std::max(1e-12, std::abs(dx));  // [cells of way a column]
  const double step_y = 1.0 / std::max(1e-12, std::abs(dy));
  double next_x = 0.5 * step_x;
  double next_y = 0.5 * step_y;
  const double end = range / truth.resolution();
  for (Cell c = from; truth.inside(c);) {
    seen[c] = 1;
    if (truth[c] == Occupancy::Occupied || std::min(next_x, next_y) > end) return;
    if (next_x < next_y) {
      c.x += dx > 0.0 ? 1 : -1;
      next_x += step_x;
    } else {
      c.y += dy > 0.0 ? 1 : -1;
      next_y += step_y;
    }
  }
}

/// Whether a free cell beside or at a corner of c is seen: corners of rooms are hidden behind the two walls they join.
bool touches_seen(const OccupancyGrid& truth, const Mask& seen, Cell c) {
  for (int y = c.y - 1; y <= c.y + 1; ++y) {
    for (int x = c.x - 1; x <= c.x + 1; ++x) {
      if (truth.inside({x, y}) && seen[{x, y}] != 0 && truth[{x, y}] == Occupancy::Free) return true;
    }
  }
  return false;
}

}  // namespace

Mask reachable_mask(const Arena& arena, const OccupancyGrid& truth, const Viewer& viewer) {
  const GridFrame& frame = truth.frame();
  const Grid<float> clearance = distance_transform(barriers(arena, frame, viewer), 1.0);
  const float needed = static_cast<float>(viewer.radius);
  Mask reached(frame);
  std::vector<Cell> open;
  const auto reach = [&](Cell c, bool is_start) {
    if (!frame.inside(c) || reached[c] != 0 || truth[c] != Occupancy::Free) return;
    if (!is_start && clearance[c] < needed) return;
    reached[c] = 1;
    open.push_back(c);
  };
  reach(frame.cell({arena.start.x, arena.start.y}), true);
  while (!open.empty()) {
    const Cell c = open.back();
    open.pop_back();
    for (const Cell next : {Cell{c.x + 1, c.y}, Cell{c.x - 1, c.y}, Cell{c.x, c.y + 1}, Cell{c.x, c.y - 1}}) {
      reach(next, false);
    }
  }
  return reached;
}

Mask visible_mask(const OccupancyGrid& truth, const Mask& reachable, const Viewer& viewer) {
  const GridFrame& frame = truth.frame();
  Mask seen(frame);
  const int stride = std::max(1, static_cast<int>(std::lround(kPoses / frame.resolution)));
  const int rays = static_cast<int>(std::ceil(2.0 * kPi * std::min(viewer.range, kFull) / frame.resolution));
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      if (reachable[{x, y}] == 0) continue;
      seen[{x, y}] = 1;
      if (x % stride != 0 || y % stride != 0) continue;
      for (int i = 0; i < rays; ++i) look(truth, {x, y}, 2.0 * kPi * (i + 0.5) / rays, viewer.range, seen);
    }
  }
  return seen;
}

OccupancyGrid visible_truth(const Arena& arena, const OccupancyGrid& truth, const Viewer& viewer) {
  const Mask seen = visible_mask(truth, reachable_mask(arena, truth, viewer), viewer);
  OccupancyGrid known = truth;
  for (int y = 0; y < truth.height(); ++y) {
    for (int x = 0; x < truth.width(); ++x) {
      const Cell c{x, y};
      const bool is_wall = truth[c] == Occupancy::Occupied;
      if (seen[c] == 0 && !(is_wall && touches_seen(truth, seen, c))) known[c] = Occupancy::Unknown;
    }
  }
  return known;
}

}  // namespace rubble::arenas
