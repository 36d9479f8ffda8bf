#include "arenas/truth/truth_map.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "arenas/model/geometry.h"
#include "arenas/model/patch_index.h"
#include "arenas/model/raster.h"
#include "arenas/model/risers.h"
#include "base/error.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

constexpr double kMostCells = 6e7;
constexpr double kThin = 1e-4;  ///< thickness given to a riser, well above kRasterTouch [m]

/// Cell centres lie on multiples of the resolution, so that a wall on a pallet line is one cell thick.
GridFrame frame_around(const Arena& arena, double resolution, double margin) {
  const double west = std::floor((arena.min_corner.x - margin) / resolution) - 0.5;
  const double south = std::floor((arena.min_corner.y - margin) / resolution) - 0.5;
  const double east = std::ceil((arena.max_corner.x + margin) / resolution) + 0.5;
  const double north = std::ceil((arena.max_corner.y + margin) / resolution) + 0.5;
  if ((east - west) * (north - south) > kMostCells)
    throw InputError("the truth map of arena '" + arena.name + "' would have " +
                     std::to_string(std::lround(east - west)) + " x " + std::to_string(std::lround(north - south)) +
                     " cells, a map has at most 60 million: ask for a coarser resolution, or move its parts together");
  return {static_cast<int>(std::lround(east - west)), static_cast<int>(std::lround(north - south)), resolution,
          west * resolution, south * resolution};
}

/// Whether a level laser that stands somewhere in the cell meets the solid. Under a wall between two pallets both
/// floors count; without any floor the foot is the ground.
bool is_in_slice(const PatchIndex& floor, const Solid& solid, const TPoint2D& c, double half, double slice_height) {
  bool has_floor = false;
  for (const TPoint2D& p : {c, TPoint2D{c.x - half, c.y}, TPoint2D{c.x + half, c.y}, TPoint2D{c.x, c.y - half},
                            TPoint2D{c.x, c.y + half}}) {
    const double z = floor.floor_height(p);
    if (!std::isfinite(z)) continue;
    has_floor = true;
    if (solid.z_bottom <= z + slice_height && z + slice_height <= solid.z_top) return true;
  }
  return !has_floor && solid.z_bottom <= slice_height && slice_height <= solid.z_top;
}

void draw_floor(const Arena& arena, OccupancyGrid& map) {
  const GridFrame& frame = map.frame();
  for (const FloorPatch& patch : arena.floor) {
    for_cells_crossed(frame, patch.outline, [&](Cell c) {
      if (contains(patch.outline, frame.centre(c))) map[c] = Occupancy::Free;
    });
  }
}

void draw_solids(const Arena& arena, double slice_height, OccupancyGrid& map) {
  const GridFrame& frame = map.frame();
  const PatchIndex floor(arena);
  const double half = 0.5 * frame.resolution;
  for (const Solid& solid : arena.solids) {
    for_cells_crossed(frame, solid.outline, [&](Cell c) {
      if (map[c] == Occupancy::Occupied) return;
      if (is_in_slice(floor, solid, frame.centre(c), half, slice_height)) map[c] = Occupancy::Occupied;
    });
  }
}

/// A step higher than the slice is a wall to the laser on its low side.
void draw_risers(const Arena& arena, double slice_height, OccupancyGrid& map) {
  for (const Riser& riser : risers(arena, slice_height)) {
    if (!riser.above_floor) continue;
    const double gap_a = riser.high_a - riser.low_a - slice_height;
    const double gap_b = riser.high_b - riser.low_b - slice_height;
    // The gap is linear along the edge: keep the part where it is positive.
    double from = 0.0;
    double to = 1.0;
    if (gap_a < 0.0) from = gap_a / (gap_a - gap_b);
    if (gap_b < 0.0) to = gap_a / (gap_a - gap_b);
    const TPoint2D along = riser.b - riser.a;
    if (std::hypot(along.x, along.y) * (to - from) < kThin) continue;
    const Outline line = strip(riser.a + along * from, riser.a + along * to, kThin);
    for_cells_crossed(map.frame(), line, [&](Cell c) { map[c] = Occupancy::Occupied; });
  }
}

/// Free pockets that the start is not connected to (over edges) become unknown.
void keep_reachable(const Arena& arena, OccupancyGrid& map) {
  Grid<std::uint8_t> reached(map.frame());
  std::vector<Cell> open;
  const auto reach = [&](Cell c) {
    if (!map.inside(c) || map[c] != Occupancy::Free || reached[c] != 0) return;
    reached[c] = 1;
    open.push_back(c);
  };
  reach(map.cell({arena.start.x, arena.start.y}));
  while (!open.empty()) {
    const Cell c = open.back();
    open.pop_back();
    for (const Cell next : {Cell{c.x + 1, c.y}, Cell{c.x - 1, c.y}, Cell{c.x, c.y + 1}, Cell{c.x, c.y - 1}})
      reach(next);
  }
  for (std::size_t i = 0; i < map.cells().size(); ++i) {
    if (map.cells()[i] == Occupancy::Free && reached.cells()[i] == 0) map.cells()[i] = Occupancy::Unknown;
  }
}

bool touches_free(const OccupancyGrid& map, Cell c) {
  for (int y = c.y - 1; y <= c.y + 1; ++y) {
    for (int x = c.x - 1; x <= c.x + 1; ++x) {
      if (map.inside({x, y}) && map[{x, y}] == Occupancy::Free) return true;
    }
  }
  return false;
}

/// Only surfaces that can be seen from reachable floor stay: the inside of solids becomes unknown.
void keep_surfaces(OccupancyGrid& map) {
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      Occupancy& cell = map[{x, y}];
      if (cell == Occupancy::Occupied && !touches_free(map, {x, y})) cell = Occupancy::Unknown;
    }
  }
}

}  // namespace

OccupancyGrid drawn_map(const Arena& arena, double resolution, double slice_height, double margin) {
  OccupancyGrid map(frame_around(arena, resolution, margin));
  draw_floor(arena, map);
  draw_solids(arena, slice_height, map);
  draw_risers(arena, slice_height, map);
  return map;
}

OccupancyGrid around_start(const Arena& arena, OccupancyGrid drawn) {
  keep_reachable(arena, drawn);
  keep_surfaces(drawn);
  return drawn;
}

OccupancyGrid truth_map(const Arena& arena, double resolution, double slice_height, double margin) {
  return around_start(arena, drawn_map(arena, resolution, slice_height, margin));
}

}  // namespace rubble::arenas
