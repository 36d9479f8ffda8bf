#include "arenas/elements/element_shapes.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "arenas/model/geometry.h"
#include "base/angle.h"
#include "base/rng.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

/// The board between x0 and x1, less the openings, which all span that stretch or none of it.
void add_boards(const ElementFrame& frame, double x0, double x1, double height, const std::vector<Opening>& openings,
                Arena& arena) {
  std::vector<const Opening*> here;
  for (const Opening& o : openings) {
    if (std::abs(o.along - 0.5 * (x0 + x1)) < 0.5 * o.width) here.push_back(&o);
  }
  std::sort(here.begin(), here.end(), [](const Opening* a, const Opening* b) { return a->height < b->height; });
  double bottom = 0.0;
  const auto add = [&](double z0, double z1) {
    add_block(frame, x0, kHalfPallet - 0.5 * kBoardThickness, x1, kHalfPallet + 0.5 * kBoardThickness, z0, z1,
              kWallElement, arena);
  };
  for (const Opening* o : here) {
    add(bottom, o->height - 0.5 * o->tall);
    bottom = o->height + 0.5 * o->tall;
  }
  add(bottom, height);
}

/// A quarter of a pallet that slopes.
struct Quarter {
  double x, y;    ///< its corner with the smallest coordinates
  double gx, gy;  ///< gradient in the own frame
  double foot;    ///< height of its low edge [m]
};

void add_quarter(const ElementFrame& frame, const Quarter& q, const char* element, Arena& arena) {
  const mrpt::math::TPoint2D origin = frame.point(0.0, 0.0);
  const mrpt::math::TPoint2D right = frame.point(1.0, 0.0) - origin;
  const mrpt::math::TPoint2D ahead = frame.point(0.0, 1.0) - origin;
  FloorPatch patch;
  patch.outline = frame.box(q.x, q.y, q.x + kHalfPallet, q.y + kHalfPallet);
  patch.z = q.foot + std::max(0.0, -(q.gx + q.gy)) * kHalfPallet;  // one of the two is zero
  patch.gx = q.gx * right.x + q.gy * ahead.x;
  patch.gy = q.gx * right.y + q.gy * ahead.y;
  patch.element = element;
  arena.floor.push_back(patch);
}

/// A box that is open to +y, between two corners in the own frame: back, sides, bottom and lid.
void add_open_box(const ElementFrame& frame, const TPoint2D& low, const TPoint2D& high, double z0, double z1,
                  Arena& arena) {
  const auto add = [&](double x0, double y0, double x1, double y1, double bottom, double top) {
    add_block(frame, x0, y0, x1, y1, bottom, top, kVictimBoxElement, arena);
  };
  constexpr double kSheet = kSheetThickness;
  add(low.x, low.y, high.x, low.y + kSheet, z0, z1);
  add(low.x, low.y + kSheet, low.x + kSheet, high.y, z0, z1);
  add(high.x - kSheet, low.y + kSheet, high.x, high.y, z0, z1);
  add(low.x + kSheet, low.y + kSheet, high.x - kSheet, high.y, z0, z0 + kSheet);
  add(low.x + kSheet, low.y + kSheet, high.x - kSheet, high.y, z1 - kSheet, z1);
}

void add_victim_at(const ElementFrame& frame, double x, double y, double z, Victim victim, Arena& arena) {
  const TPoint2D p = frame.point(x, y);
  victim.name = "victim" + std::to_string(arena.victims.size() + 1);
  victim.position = {p.x, p.y, z};
  victim.facing = frame.forward();
  arena.victims.push_back(victim);
}

double floor_or_ground(const Arena& arena, const TPoint2D& p) {
  const double z = floor_height(arena, p);
  return std::isfinite(z) ? z : 0.0;
}

}  // namespace

ElementFrame::ElementFrame(const TPoint2D& origin, double rotation)
    : origin_(origin), cos_(std::cos(-rotation)), sin_(std::sin(-rotation)) {
  // Quarter turns are exact, so that neighbours meet flush.
  if (std::abs(cos_) < 1e-9) cos_ = 0.0;
  if (std::abs(sin_) < 1e-9) sin_ = 0.0;
}

TPoint2D ElementFrame::point(double x, double y) const {
  return {origin_.x + cos_ * x - sin_ * y, origin_.y + sin_ * x + cos_ * y};
}

Outline ElementFrame::outline(const Outline& own) const {
  Outline result;
  for (const TPoint2D& p : own) result.push_back(point(p.x, p.y));
  return result;
}

Outline ElementFrame::box(double x0, double y0, double x1, double y1) const {
  return outline({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}});
}

double ElementFrame::forward() const { return std::atan2(cos_, -sin_); }

void add_block(const ElementFrame& frame, double x0, double y0, double x1, double y1, double bottom, double top,
               const std::string& element, Arena& arena, bool gives_way) {
  arena.solids.push_back({frame.box(x0, y0, x1, y1), bottom, top, element, gives_way});
}

void add_platform(const ElementFrame& frame, double x0, double y0, double x1, double y1, double z,
                  const std::string& element, Arena& arena) {
  arena.floor.push_back({frame.box(x0, y0, x1, y1), z, 0.0, 0.0, element});
}

void add_wall(const ElementFrame& frame, double height, const std::vector<Opening>& openings, Arena& arena) {
  std::vector<double> cuts{-kHalfPallet, kHalfPallet};
  for (const Opening& o : openings) {
    cuts.push_back(o.along - 0.5 * o.width);
    cuts.push_back(o.along + 0.5 * o.width);
  }
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (cuts[i + 1] - cuts[i] > 1e-6) add_boards(frame, cuts[i], cuts[i + 1], height, openings, arena);
  }
}

void add_narrow_wall(const ElementFrame& frame, Arena& arena) {
  add_block(frame, -0.5, kHalfPallet - 0.5 * kBoardThickness, 0.5, kHalfPallet + 0.5 * kBoardThickness, 0.0, 1.2,
            kWallElement, arena);
}

void add_half_wall(const ElementFrame& frame, Arena& arena) {
  add_block(frame, 0.0, kHalfPallet - 0.5 * kBoardThickness, kHalfPallet, kHalfPallet + 0.5 * kBoardThickness, 0.0, 1.2,
            kWallElement, arena);
}

void add_diagonal_wall(const ElementFrame& frame, Arena& arena) {
  arena.solids.push_back(
      {strip(frame.point(-kHalfPallet, -kHalfPallet), frame.point(kHalfPallet, kHalfPallet), kBoardThickness), 0.0, 1.2,
       kWallElement});
}

void add_corner_wall(const ElementFrame& frame, Arena& arena) {
  const TPoint2D middle = frame.point(0.0, 0.0);
  arena.solids.push_back(
      {strip(frame.point(-kHalfPallet, kHalfPallet), middle, kBoardThickness), 0.0, 1.2, kWallElement});
  arena.solids.push_back(
      {strip(middle, frame.point(kHalfPallet, kHalfPallet), kBoardThickness), 0.0, 1.2, kWallElement});
}

void add_veil(const ElementFrame& frame, Arena& arena) {
  constexpr int kStrips = 9;
  constexpr double kPitch = 0.131;
  add_block(frame, -kHalfPallet, kHalfPallet - 0.5 * kBoardThickness, kHalfPallet, kHalfPallet + 0.5 * kBoardThickness,
            1.14, 1.2, "veil", arena);
  for (int i = 0; i < kStrips; ++i) {
    const double x = kPitch * (i - kStrips / 2);
    add_block(frame, x - 0.01, kHalfPallet - 0.5 * kBoardThickness, x + 0.01, kHalfPallet + 0.5 * kBoardThickness, 0.02,
              1.14, "veil", arena, true);
  }
}

void add_ramp(const ElementFrame& frame, double foot_y, double head_y, double rise, Arena& arena) {
  const double uphill = frame.forward() + (head_y < foot_y ? kPi : 0.0);
  const double slope = rise / std::abs(head_y - foot_y);
  FloorPatch patch;
  patch.outline = frame.box(-kHalfPallet, std::min(foot_y, head_y), kHalfPallet, std::max(foot_y, head_y));
  patch.z = head_y < foot_y ? rise : 0.0;  // outline[0] lies at the smaller y
  patch.gx = slope * std::cos(uphill);
  patch.gy = slope * std::sin(uphill);
  if (std::abs(patch.gx) < 1e-9) patch.gx = 0.0;
  if (std::abs(patch.gy) < 1e-9) patch.gy = 0.0;
  patch.element = "ramp";
  arena.floor.push_back(patch);
}

void add_elevated_floor(const ElementFrame& frame, double height, Arena& arena) {
  add_platform(frame, -kHalfPallet, -kHalfPallet, kHalfPallet, kHalfPallet, height, "elevated_floor", arena);
}

void add_open_floor(const ElementFrame& frame, double height, Arena& arena) {
  add_block(frame, -kHalfPallet, -kHalfPallet, kHalfPallet, kHalfPallet, height - kPlateThickness, height,
            "elevated_floor", arena);
}

void add_roll_ramp(const ElementFrame& frame, double slope, Arena& arena) {
  const ElementFrame across(frame.point(0.0, 0.0), kPi - frame.forward());  // +y is the other's +x
  add_ramp(across, -kHalfPallet, kHalfPallet, slope * 2.0 * kHalfPallet, arena);
}

void add_wooden_block(const ElementFrame& frame, Arena& arena) {
  add_platform(frame, -0.05, -0.15, 0.05, 0.15, 0.1, "wooden_block", arena);
}

void add_post(const ElementFrame& frame, double radius, double height, const std::string& element, Arena& arena) {
  constexpr int kCorners = 16;
  Outline round;
  for (int i = 0; i < kCorners; ++i) {
    const double bearing = 2.0 * kPi * i / kCorners;
    round.push_back({radius * std::cos(bearing), radius * std::sin(bearing)});
  }
  arena.solids.push_back({frame.outline(round), 0.0, height, element});
}

void add_cube_victim(const ElementFrame& frame, Arena& arena) {
  constexpr double kHalf = 0.2;
  constexpr double kBottom = 0.2;
  add_open_box(frame, {-kHalf, -kHalf}, {kHalf, kHalf}, kBottom, kBottom + 2.0 * kHalf, arena);
  add_victim_at(frame, 0.0, 0.0, kBottom + kHalf, {}, arena);
}

void add_stairs(const ElementFrame& frame, bool open_below, Arena& arena) {
  constexpr int kTreads = 5;
  constexpr double kTread = 0.2325;
  constexpr double kLowest = 0.23;
  constexpr double kRiser = 0.2;
  for (int i = 0; i < kTreads; ++i) {
    const double y = -0.59 + kTread * i;
    const double end = i + 1 < kTreads ? y + kTread : kHalfPallet;
    const double z = kLowest + kRiser * i;
    if (open_below) {
      add_block(frame, -0.59, y, 0.59, end, z - kPlateThickness, z, "stair", arena);
    } else {
      add_platform(frame, -0.59, y, 0.59, end, z, "stair", arena);
    }
  }
}

void add_half_barrel(const ElementFrame& frame, double bottom, const std::string& element, Arena& arena) {
  constexpr double kRadius = 0.303;
  constexpr double kTall = 0.89;
  constexpr int kCorners = 12;
  Outline half;
  for (int i = 0; i <= kCorners; ++i) {
    const double bearing = kPi + kPi * i / kCorners;  // the half on this side of the wall
    half.push_back({kRadius * std::cos(bearing), 0.59 + kRadius * std::sin(bearing)});
  }
  arena.solids.push_back({frame.outline(half), bottom, bottom + kTall, element});
}

void add_fire_extinguisher(const ElementFrame& frame, Arena& arena) {
  add_block(frame, -0.32, 0.40, 0.15, kHalfPallet, 0.0, 0.89, "fire_extinguisher", arena);
}

void add_shelves(const ElementFrame& frame, Arena& arena) {
  for (const double height : {0.5, 1.0}) {
    add_block(frame, -0.59, -0.59, 0.59, 0.59, height - 0.005, height + 0.005, "shelf", arena);
  }
}

void add_spectator(const ElementFrame& frame, Arena& arena) {
  add_block(frame, -0.21, 0.08, 0.21, 0.53, 1.07, 1.70, "spectator", arena);
}

void add_hung_victim(const ElementFrame& frame, const Mount& mount, bool heat, bool sound, bool co2, Arena& arena) {
  constexpr double kWidth = 0.25;  // half of 0.50 m
  constexpr double kTall = 0.20;   // half of 0.40 m
  constexpr double kBack = 0.35;
  constexpr double kFront = 0.59;
  const double z0 = std::max(0.0, mount.height - kTall);  // what would be below the ground is not there
  const double z1 = mount.height + kTall;
  add_open_box(frame, {mount.along - kWidth, kBack}, {mount.along + kWidth, kFront}, z0, z1, arena);
  Victim victim;
  victim.heat = heat;
  victim.sound = sound;
  victim.co2 = co2;
  const double z = mount.height < kTall ? 0.5 * z1 : mount.height;
  add_victim_at(frame, mount.along, 0.5 * (kBack + kFront), z, victim, arena);
}

void add_step_field(const ElementFrame& frame, double tallest, double base, std::uint64_t thrown, Arena& arena) {
  constexpr int kColumns = 10;
  constexpr double kEdge = 0.1;
  const double step = 0.25 * tallest;
  // The league builds them at random: its counts beside the diagonal, in any order.
  std::vector<double> heights;
  for (const auto& [steps, count] : {std::pair{0, 9}, {1, 27}, {2, 33}, {3, 21}}) {
    heights.insert(heights.end(), static_cast<std::size_t>(count), step * steps);
  }
  Rng rng(thrown, "red step field");
  for (std::size_t i = heights.size(); i > 1; --i) {
    const std::size_t k = rng.below(static_cast<std::uint32_t>(i));
    std::swap(heights[i - 1], heights[k]);
  }
  std::size_t next = 0;
  for (int row = 0; row < kColumns; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const double height = base + (row == column ? tallest : heights[next++]);
      const double x = kEdge * column - 0.5;
      const double y = kEdge * row - 0.5;
      if (height > 0.0) add_platform(frame, x, y, x + kEdge, y + kEdge, height, "step_field", arena);
    }
  }
  constexpr double kPlank = 0.05;
  add_platform(frame, -0.49, -0.59, 0.49, -0.5, kPlank, "step_field", arena);
  add_platform(frame, -0.49, 0.5, 0.49, 0.59, kPlank, "step_field", arena);
  add_platform(frame, -0.59, -0.49, -0.5, 0.49, kPlank, "step_field", arena);
  add_platform(frame, 0.5, -0.49, 0.59, 0.49, kPlank, "step_field", arena);
}

void add_crossing_ramps(const ElementFrame& frame, double slope, Arena& arena) {
  // Quarter by quarter, counter-clockwise from the lower left: each rises a quarter turn further, +x first.
  for (const Quarter& q :
       {Quarter{-kHalfPallet, -kHalfPallet, slope, 0.0, 0.0}, Quarter{0.0, -kHalfPallet, 0.0, slope, 0.0},
        Quarter{0.0, 0.0, -slope, 0.0, 0.0}, Quarter{-kHalfPallet, 0.0, 0.0, -slope, 0.0}}) {
    add_quarter(frame, q, "crossing_ramp", arena);
  }
}

void add_elevated_ramps(const ElementFrame& frame, double slope, Arena& arena) {
  const double raised = slope * kHalfPallet;
  for (const Quarter& q :
       {Quarter{-kHalfPallet, -kHalfPallet, -slope, 0.0, raised}, Quarter{0.0, -kHalfPallet, 0.0, -slope, 0.0},
        Quarter{0.0, 0.0, -slope, 0.0, raised}, Quarter{-kHalfPallet, 0.0, 0.0, slope, 0.0}}) {
    add_quarter(frame, q, "elevated_ramp", arena);
  }
}

void add_tunnel(const ElementFrame& frame, Arena& arena) {
  add_block(frame, -kHalfPallet, -kHalfPallet, kHalfPallet, kHalfPallet, 0.60, 0.62, "tunnel", arena);
  for (const double x : {-kHalfPallet, kHalfPallet}) {
    add_block(frame, x - 0.5 * kBoardThickness, -kHalfPallet, x + 0.5 * kBoardThickness, kHalfPallet, 0.0, 0.60,
              "tunnel", arena);
  }
}

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
  const double aside = 0.5 * (size - kSheetThickness);
  const auto add_board = [&](const TPoint2D& middle, double length, double width) {
    arena.solids.push_back(
        {rectangle(middle, length, width, victim.facing), lowest, highest + size, kVictimBoxElement});
  };
  add_board(centre - forward * aside, kSheetThickness, size);
  add_board(centre + left * aside, size, kSheetThickness);
  add_board(centre - left * aside, size, kSheetThickness);
  arena.solids.push_back({rectangle(centre, size, size, victim.facing), highest + size - kSheetThickness,
                          highest + size, kVictimBoxElement});
}

}  // namespace rubble::arenas
