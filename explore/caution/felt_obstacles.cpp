#include "explore/caution/felt_obstacles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/planar.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr Stamp kForGood{std::numeric_limits<std::int64_t>::max()};
constexpr double kBeforeBody = 0.10;  ///< [m]
constexpr double kHalfBar = 0.2;      ///< [m]
constexpr double kNarrowBar = 0.0;    ///< the same of a pardoned thing [m]
constexpr double kBarStep = 0.1;      ///< [m]
constexpr double kBeyondEdge = 0.10;  ///< what stopped the body lies less than this ahead of it [m]
constexpr double kInset = 0.02;       ///< a pallet counts but for so much of its rim [m]
constexpr double kOnPallet = 0.20;    ///< so far inside its edges the robot's middle stands on a pallet [m]

void add_pallet(const TPose2D& T_map_pallet, bool whole, double size, std::vector<TPoint2D>& points) {
  const double half = 0.5 * size;
  if (!whole) {
    for (const TPoint2D& side : {TPoint2D{half, 0.0}, TPoint2D{-half, 0.0}, TPoint2D{0.0, half}, TPoint2D{0.0, -half}})
      points.push_back(T_map_pallet.composePoint(side));
    return;
  }
  const int steps = static_cast<int>(std::lround((size - 2.0 * kInset) / kBarStep));
  const double from = -half + kInset, step = (size - 2.0 * kInset) / std::max(1, steps);
  for (int i = 0; i <= steps; ++i)
    for (int k = 0; k <= steps; ++k)
      points.push_back(T_map_pallet.composePoint(TPoint2D{from + i * step, from + k * step}));
}

}  // namespace

TPoint2D FeltObstacles::Thing::at(double aside) const {
  return anchor.T_map_base.composePoint(TPoint2D{side * reach, aside});
}

bool FeltObstacles::holds(const Thing& thing, const TPoint2D& p_map, double margin) const {
  const TPoint2D p = thing.pallet().inverseComposePoint(p_map);
  const double half = 0.5 * config_.pallet - margin;
  return std::abs(p.x) <= half && std::abs(p.y) <= half;
}

bool FeltObstacles::feel(const Anchor& anchor, bool behind, const robot::RobotModel& model,
                         const std::optional<PalletGrid>& grid, const std::vector<TPoint2D>& trail) {
  Thing thing;
  thing.anchor = anchor;
  thing.side = behind ? -1.0 : 1.0;
  thing.reach = 0.5 * model.length + kBeforeBody;
  thing.half_bar = kHalfBar;
  if (grid && feel_pallet(thing, *grid, model, trail)) return true;
  for (const Thing& known : things_)
    if (!known.is_pallet && distance(known.at(0.0), thing.at(0.0)) < config_.same_thing) {
      thing.times = std::max(thing.times, known.times + 1);
      thing.had_its_chance = thing.had_its_chance || known.had_its_chance;
    }
  const bool for_good = thing.times >= config_.certain;
  thing.until = for_good ? kForGood : anchor.stamp + config_.memory * std::ldexp(1.0, thing.times - 1);
  things_.push_back(thing);
  return false;
}

/// Puts a touch to the account of the pallet that the body reaches into. True where all of that pallet is taken for an
/// obstacle: the robot has not stood on it and met its edge.
bool FeltObstacles::feel_pallet(const Thing& touch, const PalletGrid& grid, const robot::RobotModel& model,
                                const std::vector<TPoint2D>& trail) {
  const TPose2D& T_map_base = touch.anchor.T_map_base;
  const Cell own = grid.pallet({T_map_base.x, T_map_base.y});
  const double reach = touch.side * (0.5 * model.length + kBeyondEdge);
  const Cell there = grid.pallet(T_map_base.composePoint(TPoint2D{reach, 0.0}));
  const TPoint2D middle = grid.to_map({there.x + 0.5, there.y + 0.5});
  Thing thing = touch;
  thing.is_pallet = true;
  thing.until = kForGood;
  thing.T_base_pallet = TPose2D{middle.x, middle.y, grid.angle} - T_map_base;
  thing.inside = there == own;
  const bool stood_on = thing.inside || std::any_of(trail.begin(), trail.end(),
                                                    [&](const TPoint2D& p) { return holds(thing, p, kOnPallet); });
  thing.whole = thing.stubs = !stood_on;
  for (Thing& known : things_) {
    if (!known.is_pallet || distance({known.pallet().x, known.pallet().y}, middle) > 0.5 * config_.pallet) continue;
    thing.certain = !stood_on && (known.certain || !known.whole);
    thing.times = known.times + 1;
    thing.had_its_chance = known.had_its_chance;
    thing.stubs = thing.stubs || known.stubs || thing.times > 1;
    known = thing;
    return !stood_on;
  }
  things_.push_back(thing);
  return !stood_on;
}

void FeltObstacles::passed(const TPose2D& T_map_base, const robot::RobotModel& model) {
  const double radius = 0.25 * model.width;
  const TPoint2D here{T_map_base.x, T_map_base.y};
  for (Thing& thing : things_) {
    if (!thing.is_pallet) continue;
    thing.inside = holds(thing, here, 0.0);
    if (holds(thing, here, kOnPallet)) thing.whole = thing.certain = false;
  }
  things_.erase(
      std::remove_if(things_.begin(), things_.end(),
                     [&](const Thing& thing) { return !thing.is_pallet && distance(thing.at(0.0), here) < radius; }),
      things_.end());
}

void FeltObstacles::follow(const slam::Mapper& mapper) {
  for (Thing& thing : things_) thing.anchor.follow(mapper);
}

std::vector<TPoint2D> FeltObstacles::points(Stamp now) const {
  std::vector<TPoint2D> points;
  for (const Thing& thing : things_) {
    if (!counts(thing, now)) continue;
    if (thing.is_pallet) {
      add_pallet(thing.pallet(), closed(thing), config_.pallet, points);
      continue;
    }
    for (double aside = -thing.half_bar; aside < thing.half_bar + 0.5 * kBarStep; aside += kBarStep)
      points.push_back(thing.at(aside));
  }
  return points;
}

int FeltObstacles::count(Stamp now) const {
  return static_cast<int>(
      std::count_if(things_.begin(), things_.end(), [&](const Thing& thing) { return counts(thing, now); }));
}

bool FeltObstacles::forget(Stamp now) {
  const bool any = count(now) > 0;
  for (Thing& thing : things_) thing.until = std::min(thing.until, now);
  return any;
}

bool FeltObstacles::forget_once(Stamp now) {
  bool any = false;
  for (Thing& thing : things_) {
    if (thing.had_its_chance) continue;
    any = any || counts(thing, now);
    thing.had_its_chance = true;
    thing.until = std::min(thing.until, now);
  }
  return any;
}

bool FeltObstacles::pardon(Stamp now) {
  bool any = false;
  for (Thing& thing : things_) {
    if (!counts(thing, now)) continue;
    if (thing.is_pallet ? !thing.whole || thing.certain : thing.half_bar <= kNarrowBar) continue;
    thing.half_bar = kNarrowBar;
    thing.whole = false;
    any = true;
  }
  if (any) return true;
  for (Thing& thing : things_) {
    const bool certain = thing.is_pallet ? thing.certain || closed(thing) : thing.times >= config_.certain;
    if (!counts(thing, now) || certain) continue;
    thing.until = now;
    any = true;
  }
  return any;
}

}  // namespace rubble::explore
