#include "explore/caution/felt_obstacles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/planar.h"
#include "base/wall_between.h"
#include "explore/caution/step_field.h"

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
constexpr double kCorner = 0.4;       ///< corners of the body lie so much of its width beside its middle
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
                         const std::optional<PalletGrid>& grid, const std::vector<TPoint2D>& trail,
                         const OccupancyGrid* known, bool sure) {
  Thing thing;
  thing.sure = sure;
  thing.anchor = anchor;
  thing.side = behind ? -1.0 : 1.0;
  thing.reach = 0.5 * model.length + kBeforeBody;
  thing.half_bar = kHalfBar;
  if (grid && feel_pallet(thing, *grid, model, trail, known)) return true;
  for (const Thing& other : things_)
    if (!other.is_pallet && distance(other.at(0.0), thing.at(0.0)) < config_.same_thing) {
      thing.times = std::max(thing.times, other.times + 1);
      thing.had_its_chance = thing.had_its_chance || other.had_its_chance;
    }
  const bool for_good = thing.times >= config_.certain;
  thing.until = for_good ? kForGood : anchor.stamp + config_.memory * std::ldexp(1.0, thing.times - 1);
  things_.push_back(thing);
  return false;
}

bool FeltObstacles::is_pallet_at(const Thing& thing, const TPoint2D& middle) const {
  return thing.is_pallet && distance(position(thing.pallet()), middle) <= 0.5 * config_.pallet;
}

bool FeltObstacles::felt_on(const TPoint2D& middle) const {
  return std::any_of(things_.begin(), things_.end(), [&](const Thing& thing) { return is_pallet_at(thing, middle); });
}

/// The pallet that the body reaches into: what lies before its middle. A corner of it may have met the edge of another:
/// the one pallet before a corner counts before that which it stands on, and before one ahead that it has stood on. Of
/// two that it has not stood on nobody can tell, but that what was felt before is it again. A step field beside a
/// corner that nothing kept the robot from is it, whatever else it reaches into: cutting that field's corner on the way
/// into a lane says nothing of the lane.
std::optional<Cell> FeltObstacles::reached(const Thing& touch, const PalletGrid& grid, const robot::RobotModel& model,
                                           const std::vector<TPoint2D>& trail, const OccupancyGrid* known) const {
  const TPose2D& T_map_base = touch.anchor.T_map_base;
  const double front = touch.side * 0.5 * model.length;
  const double reach = front + touch.side * kBeyondEdge;
  const double aside = kCorner * model.width;
  const Cell own = grid.pallet(position(T_map_base));
  const Cell ahead = grid.pallet(T_map_base.composePoint(TPoint2D{reach, 0.0}));
  // Among steps, those it stands on stop it: only the higher ones show.
  if (known != nullptr && shows_step_field(*known, grid, own)) return own;
  if (known != nullptr)
    if (const auto field = field_beside(touch, grid, model, trail, *known)) return field;
  if (ahead == own) {
    // Steps were felt on its own one before: it is that again.
    if (felt_on(grid.middle(own))) return own;
    const std::vector<Cell> others = new_pallets({{reach, -aside}, {reach, aside}}, T_map_base, grid, trail, known);
    return others.size() == 1 ? others.front() : own;
  }
  const double shoulder = touch.side * kCorner * model.length, side = 0.5 * model.width;
  const std::vector<Cell> others =
      new_pallets({{reach, 0.0}, {front, -aside}, {front, aside}, {shoulder, -side}, {shoulder, side}}, T_map_base,
                  grid, trail, known);
  if (others.empty()) return ahead;
  if (others.size() == 1) return others.front();
  for (const Cell pallet : others)
    if (felt_on(grid.middle(pallet))) return pallet;
  return std::nullopt;
}

/// The only step field that a corner of the body, on the side to which it drives, is above or nearly so; none that is
/// an obstacle already.
std::optional<Cell> FeltObstacles::field_beside(const Thing& touch, const PalletGrid& grid,
                                                const robot::RobotModel& model, const std::vector<TPoint2D>& trail,
                                                const OccupancyGrid& known) const {
  const double reach = touch.side * (0.5 * model.length + kBeyondEdge), aside = kCorner * model.width;
  const double shoulder = touch.side * kCorner * model.length, side = 0.5 * model.width + kBeyondEdge;
  std::vector<Cell> fields = new_pallets({{reach, -aside}, {reach, aside}, {shoulder, -side}, {shoulder, side}},
                                         touch.anchor.T_map_base, grid, trail, &known);
  const auto is_no_new_field = [&](Cell pallet) {
    const TPoint2D middle = grid.middle(pallet);
    return !shows_step_field(known, grid, pallet) ||
           std::any_of(things_.begin(), things_.end(), [&](const Thing& thing) {
             return is_pallet_at(thing, middle) && counts(thing, touch.anchor.stamp) && closed(thing);
           });
  };
  fields.erase(std::remove_if(fields.begin(), fields.end(), is_no_new_field), fields.end());
  return fields.size() == 1 ? std::optional(fields.front()) : std::nullopt;
}

/// The pallets below points of the body but its own, if the robot has not stood on them and no wall of the map is
/// between.
std::vector<Cell> FeltObstacles::new_pallets(const std::vector<TPoint2D>& points, const TPose2D& T_map_base,
                                             const PalletGrid& grid, const std::vector<TPoint2D>& trail,
                                             const OccupancyGrid* known) {
  const TPoint2D here = position(T_map_base);
  const Cell own = grid.pallet(here);
  std::vector<Cell> pallets;
  for (const TPoint2D& point : points) {
    const TPoint2D at = T_map_base.composePoint(point);
    const Cell pallet = grid.pallet(at);
    const auto stood = [&](const TPoint2D& p) { return grid.pallet(p) == pallet && grid.depth(p) > kOnPallet; };
    if (pallet == own || (known != nullptr && wall_between(*known, here, at)) ||
        std::find(pallets.begin(), pallets.end(), pallet) != pallets.end() ||
        std::any_of(trail.begin(), trail.end(), stood))
      continue;
    pallets.push_back(pallet);
  }
  return pallets;
}

/// Puts a touch to the account of the pallet that the body reaches into. True where all of that pallet is taken for an
/// obstacle: the robot has not stood on it and met its edge.
bool FeltObstacles::feel_pallet(const Thing& touch, const PalletGrid& grid, const robot::RobotModel& model,
                                const std::vector<TPoint2D>& trail, const OccupancyGrid* known) {
  const TPose2D& T_map_base = touch.anchor.T_map_base;
  const Cell own = grid.pallet(position(T_map_base));
  const std::optional<Cell> met = reached(touch, grid, model, trail, known);
  if (!met) return false;
  const Cell there = *met;
  const TPoint2D middle = grid.middle(there);
  Thing thing = touch;
  thing.is_pallet = true;
  thing.until = kForGood;
  thing.T_base_pallet = TPose2D{middle.x, middle.y, grid.angle()} - T_map_base;
  thing.inside = there == own;
  const bool stood_on = thing.inside || std::any_of(trail.begin(), trail.end(),
                                                    [&](const TPoint2D& p) { return holds(thing, p, kOnPallet); });
  thing.whole = thing.stubs = !stood_on;
  thing.shut = known != nullptr && shows_step_field(*known, grid, there);
  for (Thing& before : things_) {
    if (!is_pallet_at(before, middle)) continue;
    thing.certain = !stood_on && (before.certain || !before.whole);
    thing.sure = thing.sure || before.sure;
    thing.times = before.times + 1;
    thing.had_its_chance = before.had_its_chance;
    thing.let_go = before.let_go;
    thing.held = before.held;
    thing.shut = thing.shut || before.shut;
    thing.stubs = thing.stubs || before.stubs || thing.times > 1;
    before = thing;
    return !stood_on;
  }
  things_.push_back(thing);
  return !stood_on;
}

std::optional<Trap> FeltObstacles::trap(const TPose2D& T_map_base) {
  for (Thing& thing : things_) {
    if (!thing.is_pallet || !(thing.let_go || thing.held) || !holds(thing, position(T_map_base), 0.0)) continue;
    thing.inside = thing.shut = thing.stubs = true;
    thing.until = kForGood;
    return Trap{thing.anchor, thing.T_base_pallet, config_.pallet};
  }
  return std::nullopt;
}

void FeltObstacles::not_got_free(const Anchor& anchor, const PalletGrid& grid) {
  const TPoint2D middle = grid.middle(grid.pallet(position(anchor.T_map_base)));
  auto thing = std::find_if(things_.begin(), things_.end(), [&](const Thing& t) { return is_pallet_at(t, middle); });
  if (thing == things_.end()) {
    Thing pallet;
    pallet.anchor = anchor;
    pallet.is_pallet = true;
    pallet.T_base_pallet = TPose2D{middle.x, middle.y, grid.angle()} - anchor.T_map_base;
    thing = things_.insert(things_.end(), pallet);
  }
  thing->inside = thing->stubs = thing->held = true;
  thing->until = kForGood;
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

void FeltObstacles::let_go(Thing& thing, Stamp now) const {
  thing.let_go = thing.let_go || (thing.is_pallet && counts(thing, now) && closed(thing));
  thing.until = std::min(thing.until, now);
}

bool FeltObstacles::forget(Stamp now) {
  const bool any = count(now) > 0;
  for (Thing& thing : things_) let_go(thing, now);
  return any;
}

bool FeltObstacles::forget_once(Stamp now) {
  bool any = false;
  for (Thing& thing : things_) {
    if (thing.had_its_chance) continue;
    any = any || counts(thing, now);
    thing.had_its_chance = true;
    let_go(thing, now);
  }
  return any;
}

bool FeltObstacles::has_chances() const {
  return std::any_of(things_.begin(), things_.end(), [](const Thing& thing) { return !thing.had_its_chance; });
}

bool FeltObstacles::pardon(Stamp now) {
  bool any = false;
  for (Thing& thing : things_) {
    if (!counts(thing, now)) continue;
    if (thing.is_pallet ? !thing.whole || thing.certain || thing.sure : thing.half_bar <= kNarrowBar) continue;
    thing.half_bar = kNarrowBar;
    thing.let_go = thing.is_pallet;
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
