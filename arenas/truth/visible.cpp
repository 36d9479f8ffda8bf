#include "arenas/truth/visible.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "arenas/model/geometry.h"
#include "arenas/model/patch_index.h"
#include "arenas/model/raster.h"
#include "arenas/model/rims.h"
#include "arenas/model/risers.h"
#include "base/angle.h"
#include "base/distance_transform.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;
using Mask = Grid<std::uint8_t>;

constexpr double kEdgeThickness = 1e-4;  ///< thickness given to an edge [m]
constexpr double kVeil = 0.08;           ///< half the pitch of its strips, and a little [m]
constexpr double kPoses = 0.4;           ///< distance between the poses looked from [m]
constexpr double kSteepBand = 0.12;      ///< before floor that ends a ray, where a map may show a wall or not [m]
constexpr double kBeside = 0.40;  ///< floor so far from all ground that the robot reaches is none to drive on [m]
constexpr double kFull = 8.0;     ///< up to here neighbouring rays end in neighbouring cells [m]

/// Cells with something the body cannot pass: solids at its height, steps too high to climb, floor too steep, the rim.
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
  for (const FloorPatch& patch : arena.floor) {
    if (std::hypot(patch.gx, patch.gy) <= std::tan(viewer.max_slope)) continue;
    for_cells_crossed(frame, patch.outline, [&](Cell c) {
      const TPoint2D p = frame.centre(c);
      if (contains(patch.outline, p) && patch.height(p) >= floor.floor_height(p) - kEdgeThickness) mask[c] = 1;
    });
  }
  for (const Riser& riser : risers(arena, viewer.climbable_step)) {
    const Stretch stretch = too_high(riser, viewer.climbable_step);  // as the simulator closes it
    const TPoint2D along = riser.b - riser.a;
    if (std::hypot(along.x, along.y) * (stretch.to - stretch.from) < kEdgeThickness) continue;
    const Outline line = strip(riser.a + along * stretch.from, riser.a + along * stretch.to, kEdgeThickness);
    for_cells_crossed(frame, line, [&](Cell c) { mask[c] = 1; });
  }
  for (const Rim& rim : open_rims(arena, viewer.climbable_step))
    for_cells_crossed(frame, strip(rim.a, rim.b, kEdgeThickness), [&](Cell c) { mask[c] = 1; });
  return mask;
}

/// Reachable cells, the start first, so that every one is less than kPoses from a chosen one and no two of them are.
std::vector<Cell> poses_among(const Mask& reachable, Cell start) {
  const GridFrame& frame = reachable.frame();
  const int apart = std::max(1, static_cast<int>(std::lround(kPoses / frame.resolution)));  // [cells]
  const int columns = frame.width / apart + 1;
  const int rows = frame.height / apart + 1;
  std::vector<Cell> chosen;
  std::vector<std::vector<Cell>> buckets(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const auto bucket = [&](int x, int y) -> std::vector<Cell>& {
    return buckets[static_cast<std::size_t>(y * columns + x)];
  };
  const auto is_covered = [&](Cell c) {
    for (int y = std::max(0, c.y / apart - 1); y <= std::min(rows - 1, c.y / apart + 1); ++y) {
      for (int x = std::max(0, c.x / apart - 1); x <= std::min(columns - 1, c.x / apart + 1); ++x) {
        for (const Cell other : bucket(x, y)) {
          const int dx = other.x - c.x;
          const int dy = other.y - c.y;
          if (dx * dx + dy * dy < apart * apart) return true;
        }
      }
    }
    return false;
  };
  const auto consider = [&](Cell c) {
    if (reachable[c] == 0 || is_covered(c)) return;
    bucket(c.x / apart, c.y / apart).push_back(c);
    chosen.push_back(c);
  };
  if (frame.inside(start)) consider(start);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) consider({x, y});
  return chosen;
}

/// Height of the floor under the middle of each cell; the ground's where there is none.
Grid<float> floor_heights(const Arena& arena, const GridFrame& frame) {
  const PatchIndex floor(arena);
  Grid<float> heights(frame);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const double z = floor.floor_height(frame.centre({x, y}));
      heights[{x, y}] = std::isfinite(z) ? static_cast<float>(z) : 0.0F;
    }
  return heights;
}

constexpr float kNoEdge = -1e9F;

/// Cells that are occupied by a step between two floors alone: the height of its upper floor [m], to a laser above
/// which it is a drop and no wall. kNoEdge elsewhere.
Grid<float> edges_of(const Arena& arena, const GridFrame& frame, double slice_height) {
  Grid<float> tops(frame, kNoEdge);
  for (const Riser& riser : risers(arena, slice_height)) {
    const TPoint2D along = riser.b - riser.a;
    const double size2 = along.x * along.x + along.y * along.y;
    if (!riser.above_floor || size2 < kEdgeThickness * kEdgeThickness) continue;
    for_cells_crossed(frame, strip(riser.a, riser.b, kEdgeThickness), [&](Cell c) {
      const TPoint2D way = frame.centre(c) - riser.a;
      const double t = std::clamp((way.x * along.x + way.y * along.y) / size2, 0.0, 1.0);
      tops[c] = std::max(tops[c], static_cast<float>(riser.high_a + t * (riser.high_b - riser.high_a)));
    });
  }
  for (const Solid& solid : arena.solids) {
    for_cells_crossed(frame, solid.outline, [&](Cell c) {
      if (static_cast<float>(solid.z_top) > tops[c]) tops[c] = kNoEdge;
    });
  }
  return tops;
}

/// The heights that decide what a ray meets, cell by cell [m].
struct Heights {
  Grid<float> floor;
  Grid<float> edge;
};

/// What was seen, and where rays ended at floor as high as the laser.
struct Seen {
  Mask cells;
  Mask floor_ahead;
  Grid<float> lowest;  ///< height of the lowest laser that saw the cell [m]
};

/// Marks what one ray sees: a walk from cell to cell (Amanatides and Woo 1987), up to floor as high as the laser. It
/// passes over edges below the laser.
void look(const OccupancyGrid& truth, const Heights& heights, Cell from, double bearing, const Viewer& viewer,
          Seen& seen) {
  const float laser = heights.floor[from] + static_cast<float>(viewer.laser_height);
  const double dx = std::cos(bearing);
  const double dy = std::sin(bearing);
  const double step_x = 1.0 / std::max(1e-12, std::abs(dx));  // [cells of way a column]
  const double step_y = 1.0 / std::max(1e-12, std::abs(dy));
  double next_x = 0.5 * step_x;
  double next_y = 0.5 * step_y;
  const double end = viewer.range / truth.resolution();
  for (Cell c = from; truth.inside(c);) {
    if (heights.floor[c] >= laser) {
      seen.floor_ahead[c] = 1;
      return;
    }
    const bool is_wall = truth[c] == Occupancy::Occupied;
    const bool is_drop = is_wall && heights.edge[c] != kNoEdge && heights.edge[c] < laser;
    if (!is_drop) seen.cells[c] = 1;
    seen.lowest[c] = std::min(seen.lowest[c], laser);
    if ((is_wall && !is_drop) || std::min(next_x, next_y) > end) return;
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
/// Beside the edge of a floor only from below it: from above there is no wall.
bool touches_seen(const OccupancyGrid& truth, const Grid<float>& edges, const Seen& seen, Cell c) {
  for (int y = c.y - 1; y <= c.y + 1; ++y) {
    for (int x = c.x - 1; x <= c.x + 1; ++x) {
      const Cell beside{x, y};
      if (!truth.inside(beside) || seen.cells[beside] == 0 || truth[beside] != Occupancy::Free) continue;
      if (edges[c] == kNoEdge || seen.lowest[beside] <= edges[c]) return true;
    }
  }
  return false;
}

/// Strips of a veil and the gaps between them: which of their cells a map shows as wall is a matter of half a cell.
void leave_open(const Arena& arena, OccupancyGrid& known) {
  for (const Solid& solid : arena.solids) {
    if (!solid.gives_way) continue;
    for_cells_crossed(known.frame(), solid.outline, [&](Cell c) { known[c] = Occupancy::Unknown; });
    TPoint2D middle{0.0, 0.0};
    for (const TPoint2D& p : solid.outline) middle = middle + p * (1.0 / static_cast<double>(solid.outline.size()));
    for_cells_crossed(known.frame(), rectangle(middle, 2.0 * kVeil, 2.0 * kVeil), [&](Cell c) {
      if (known[c] == Occupancy::Free) known[c] = Occupancy::Unknown;
    });
  }
}

}  // namespace

Grid<float> standing_room(const Arena& arena, const OccupancyGrid& truth, const Viewer& viewer) {
  Grid<float> room = distance_transform(barriers(arena, truth.frame(), viewer), 1.0);
  for (std::size_t i = 0; i < truth.frame().size(); ++i)
    if (truth.cells()[i] != Occupancy::Free) room.data()[i] = 0.0F;
  return room;
}

Mask reachable_mask(const Arena& arena, const OccupancyGrid& truth, const Viewer& viewer) {
  return reachable_mask({arena.start.x, arena.start.y}, truth, standing_room(arena, truth, viewer), viewer);
}

Mask reachable_mask(const TPoint2D& start, const OccupancyGrid& truth, const Grid<float>& room, const Viewer& viewer) {
  const GridFrame& frame = truth.frame();
  const float needed = static_cast<float>(viewer.radius);
  Mask reached(frame);
  std::vector<Cell> open;
  const auto reach = [&](Cell c, bool is_start) {
    if (!frame.inside(c) || reached[c] != 0 || truth[c] != Occupancy::Free) return;
    if (!is_start && room[c] < needed) return;
    reached[c] = 1;
    open.push_back(c);
  };
  reach(frame.cell(start), true);
  while (!open.empty()) {
    const Cell c = open.back();
    open.pop_back();
    for (const Cell next : {Cell{c.x + 1, c.y}, Cell{c.x - 1, c.y}, Cell{c.x, c.y + 1}, Cell{c.x, c.y - 1}}) {
      reach(next, false);
    }
  }
  return reached;
}

namespace {

Heights heights_of(const Arena& arena, const GridFrame& frame, const Viewer& viewer) {
  return {floor_heights(arena, frame), edges_of(arena, frame, viewer.laser_height)};
}

Seen look_around(const Arena& arena, const OccupancyGrid& truth, const Heights& heights, const Mask& reachable,
                 const Viewer& viewer, const std::function<void(double)>& progress) {
  const GridFrame& frame = truth.frame();
  Seen seen{reachable, Mask(frame), Grid<float>(frame, std::numeric_limits<float>::infinity())};
  const int rays = static_cast<int>(std::ceil(2.0 * kPi * std::min(viewer.range, kFull) / frame.resolution));
  const std::vector<Cell> poses = poses_among(reachable, frame.cell({arena.start.x, arena.start.y}));
  for (std::size_t k = 0; k < poses.size(); ++k) {
    for (int i = 0; i < rays; ++i) look(truth, heights, poses[k], 2.0 * kPi * (i + 0.5) / rays, viewer, seen);
    if (progress) progress(static_cast<double>(k + 1) / static_cast<double>(poses.size()));
  }
  return seen;
}

/// Where floor that the robot never drives on rises past the laser (steep ramps, stairs), a level laser sees a wall
/// that the truth does not have, from each height at another place: a map that shows it is right, and so is one that
/// does not. On ramps that the robot can climb such a wall is a phantom, and stays one; where the truth has a
/// wall itself, as the diagonal of a step field, it counts.
void leave_open_before_floor(const Mask& floor_ahead, const Mask& reachable, OccupancyGrid& known) {
  const Grid<float> to_reachable = distance_transform(reachable, 2.0 * kBeside);
  Mask walls(known.frame());
  for (std::size_t i = 0; i < known.frame().size(); ++i) walls.data()[i] = known.data()[i] == Occupancy::Occupied;
  const Grid<float> to_wall = distance_transform(walls, 2.0 * kSteepBand);
  Mask ends(known.frame());
  bool any = false;
  for (int y = 0; y < known.height(); ++y)
    for (int x = 0; x < known.width(); ++x) {
      const Cell c{x, y};
      if (floor_ahead[c] == 0 || static_cast<double>(to_reachable[c]) <= kBeside ||
          static_cast<double>(to_wall[c]) <= kSteepBand)
        continue;
      ends[c] = 1;
      any = true;
    }
  if (!any) return;
  const Grid<float> to_end = distance_transform(ends, 2.0 * kSteepBand);
  for (int y = 0; y < known.height(); ++y)
    for (int x = 0; x < known.width(); ++x) {
      const Cell c{x, y};
      if (known[c] == Occupancy::Free && static_cast<double>(to_end[c]) <= kSteepBand) known[c] = Occupancy::Unknown;
    }
}

/// Cells with a wall somewhere in each of the four directions.
Mask between_walls(const OccupancyGrid& truth) {
  Mask directions(truth.frame());
  const auto sweep = [&](int lines, int length, std::uint8_t bit, auto cell) {
    for (int line = 0; line < lines; ++line) {
      bool behind_wall = false;
      for (int i = 0; i < length; ++i) {
        const Cell c = cell(line, i);
        behind_wall = behind_wall || truth[c] == Occupancy::Occupied;
        if (behind_wall) directions[c] = static_cast<std::uint8_t>(directions[c] | bit);
      }
    }
  };
  const int width = truth.width();
  const int height = truth.height();
  sweep(height, width, 1, [](int y, int x) { return Cell{x, y}; });
  sweep(height, width, 2, [&](int y, int x) { return Cell{width - 1 - x, y}; });
  sweep(width, height, 4, [](int x, int y) { return Cell{x, y}; });
  sweep(width, height, 8, [&](int x, int y) { return Cell{x, height - 1 - y}; });
  for (std::uint8_t& d : directions.cells()) d = d == 15 ? 1 : 0;
  return directions;
}

/// Ground outside the walls, if there are any, is asked for as far as a laser there still sees one of them.
void leave_open_ground(const OccupancyGrid& truth, double range, OccupancyGrid& known) {
  const Mask inside = between_walls(truth);
  Mask walls(truth.frame());
  for (std::size_t i = 0; i < truth.frame().size(); ++i) walls.data()[i] = truth.data()[i] == Occupancy::Occupied;
  if (std::count(walls.cells().begin(), walls.cells().end(), 1) == 0) return;
  const Grid<float> to_wall = distance_transform(walls, 2.0 * range);
  for (std::size_t i = 0; i < truth.frame().size(); ++i)
    if (inside.data()[i] == 0 && static_cast<double>(to_wall.data()[i]) > range && known.data()[i] == Occupancy::Free)
      known.data()[i] = Occupancy::Unknown;
}

}  // namespace

Mask visible_mask(const Arena& arena, const OccupancyGrid& truth, const Mask& reachable, const Viewer& viewer,
                  const std::function<void(double)>& progress) {
  return look_around(arena, truth, heights_of(arena, truth.frame(), viewer), reachable, viewer, progress).cells;
}

OccupancyGrid visible_truth(const Arena& arena, const OccupancyGrid& truth, const Viewer& viewer,
                            const std::function<void(double)>& progress) {
  const Mask reachable = reachable_mask(arena, truth, viewer);
  const Heights heights = heights_of(arena, truth.frame(), viewer);
  const Seen looked = look_around(arena, truth, heights, reachable, viewer, progress);
  const Mask& seen = looked.cells;
  OccupancyGrid known = truth;
  for (int y = 0; y < truth.height(); ++y) {
    for (int x = 0; x < truth.width(); ++x) {
      const Cell c{x, y};
      const bool is_wall = truth[c] == Occupancy::Occupied;
      if (seen[c] == 0 && !(is_wall && touches_seen(truth, heights.edge, looked, c))) known[c] = Occupancy::Unknown;
    }
  }
  leave_open(arena, known);
  leave_open_before_floor(looked.floor_ahead, reachable, known);
  leave_open_ground(truth, viewer.range, known);
  return known;
}

}  // namespace rubble::arenas
