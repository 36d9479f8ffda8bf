#include "explore/motion/corner_room.h"

#include <algorithm>
#include <cmath>

#include "base/planar.h"
#include "explore/motion/pivot.h"
#include "explore/plan/path_follower.h"
#include "robot/body.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::Drive;

constexpr double kKeepOff = 0.045;    ///< corners keep so far from walls [m]
constexpr double kBetter = 0.004;     ///< another drive must keep so much more [m]
constexpr double kMostOff = 0.45;     ///< from where the turn began; farther it turns as told [m]
constexpr double kForesight = 0.40;   ///< the body is moved ahead by so much [s]
constexpr int kForesightSteps = 4;    ///< in so many steps
constexpr double kRolls = 0.15;       ///< faster, it is no longer on its spot before it has stopped [m/s]
constexpr double kWallsWithin = 0.6;  ///< [m]
constexpr double kSameWall = 0.10;    ///< a hit so near to a wall of the map is of that wall [m]
constexpr double kBeforeEnds = 0.07;  ///< of the body the floor must be known to drive there [m]
constexpr double kApart = 0.02;       ///< hits nearer to each other tell nothing new [m]

}  // namespace

void CornerRoom::find_walls(const TPose2D& T_map_base, const Traversable& floor, const std::vector<TPoint2D>& hits) {
  walls_.clear();
  const TPoint2D here = position(T_map_base);
  const PlanarTransform T(T_map_base);
  const auto add = [&](const TPoint2D& p, double radius) {
    walls_.push_back({T.turned_back(p.x - here.x, p.y - here.y), radius});
  };
  const auto is_wall = [&](Cell c) { return floor.obstacle.inside(c) && floor.obstacle[c] != 0; };
  const Cell low = floor.cells.cell({here.x - kWallsWithin, here.y - kWallsWithin});
  const Cell high = floor.cells.cell({here.x + kWallsWithin, here.y + kWallsWithin});
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x)
      if (is_wall({x, y}) && distance(floor.cells.centre({x, y}), here) < kWallsWithin)
        add(floor.cells.centre({x, y}), 0.5 * floor.frame().resolution);
  // What stands alone may be paper, which gives way.
  const int near = static_cast<int>(kSameWall / floor.frame().resolution);
  const auto of_wall = [&](const TPoint2D& p) {
    const Cell c = floor.cells.cell(p);
    for (int dy = -near; dy <= near; ++dy)
      for (int dx = -near; dx <= near; ++dx)
        if (is_wall({c.x + dx, c.y + dy})) return true;
    return false;
  };
  const TPoint2D* last = nullptr;
  for (const TPoint2D& hit : hits) {
    if (distance(hit, here) >= kWallsWithin || (last != nullptr && distance(hit, *last) < kApart) || !of_wall(hit))
      continue;
    add(hit, 0.0);
    last = &hit;
  }
}

/// Between the body, moved so, and the nearest wall; below 0: inside it.
double CornerRoom::gap(const TPose2D& T_base_then) const {
  const PlanarTransform T(T_base_then);
  double least = kWallsWithin;
  for (const Wall& wall : walls_) {
    const TPoint2D p = T.inverse(wall.at);
    least = std::min(least, robot::to_body(model_, p.x, p.y) - wall.radius);
  }
  return least;
}

/// Whether the floor right before the body is known to be free, or behind it where `way` is -1.
bool CornerRoom::seen(const TPose2D& T_map_base, const Traversable& floor, double way) const {
  for (const double side : {-0.4, 0.0, 0.4}) {
    const Cell c = floor.cells.cell(
        T_map_base.composePoint(TPoint2D{way * (0.5 * model_.length + kBeforeEnds), side * model_.width}));
    if (!floor.cells.inside(c) || floor.cells[c] != Occupancy::Free) return false;
  }
  return true;
}

/// As the base follows its ramps to a drive. kKeepOff: at least that.
double CornerRoom::least_gap(const Drive& drive) const {
  constexpr double kStep = kForesight / kForesightSteps;
  double least = kKeepOff;
  Drive now = moving_;
  TPose2D T_base_then;
  for (int i = 0; i < kForesightSteps; ++i) {
    now.v = robot::approach(now.v, drive.v, model_.max_accel * kStep);
    now.w = robot::approach(now.w, drive.w, model_.max_turn_accel * kStep);
    const double middle = T_base_then.phi + 0.5 * now.w * kStep;  // the chord of the arc
    T_base_then.x += now.v * kStep * std::cos(middle);
    T_base_then.y += now.v * kStep * std::sin(middle);
    T_base_then.phi += now.w * kStep;
    least = std::min(least, gap(T_base_then));
  }
  return least;
}

CornerRoom::Kept CornerRoom::keep(const Drive& drive, const Drive& moving, const Anchor& robot,
                                  const Traversable& floor, const std::vector<TPoint2D>& hits) {
  const TPose2D& T_map_base = robot.T_map_base;
  if (!spot_) {
    spot_.emplace(robot, position(T_map_base));
    to_or_fro_ = 0.0;
  }
  find_walls(T_map_base, floor, hits);
  moving_ = moving;
  const bool rolls = std::abs(moving.v) > kRolls;
  if (walls_.empty() || (!rolls && distance(spot_->p_map(), position(T_map_base)) > kMostOff)) return {drive};
  const double told = least_gap(drive);
  const double here = gap({}), now = std::min(kKeepOff, here);
  if (told >= kKeepOff || told >= now) return {drive};
  Drive best = drive;
  double best_gap = told + kBetter;
  const bool may_go = seen(T_map_base, floor, 1.0), may_back = seen(T_map_base, floor, -1.0);
  // The fastest turns first: of drives that keep as far off the first one is taken.
  const double slow = std::copysign(std::min(kLeastTurn, std::abs(drive.w)), drive.w);
  for (const double w : {drive.w, 0.5 * drive.w, slow, 0.0})
    for (const double v :
         {0.0, 0.5 * Pivot::kMostSpeed, -0.5 * Pivot::kMostSpeed, Pivot::kMostSpeed, -Pivot::kMostSpeed}) {
      if ((v > 0.0 && !may_go) || (v < 0.0 && !may_back)) continue;
      const Drive other{v, w};
      double keeps = least_gap(other);
      // A drive that turns no more has to lead off the wall, or ends in time what the robot still rolls.
      if (w == 0.0 && !rolls && (v == 0.0 || gap({v * kForesight, 0.0, 0.0}) < here + 0.5 * kBetter)) continue;
      if (v * to_or_fro_ < 0.0) keeps -= kBetter;
      if (keeps <= best_gap) continue;
      best = other;
      best_gap = keeps;
    }
  if (rolls && least_gap(best) < std::min(now, kKeepOff - kBetter)) return {{}, true};
  if (best.v != 0.0) to_or_fro_ = best.v > 0.0 ? 1.0 : -1.0;
  return {best};
}

}  // namespace rubble::explore
