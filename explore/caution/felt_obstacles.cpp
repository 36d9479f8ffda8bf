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

}  // namespace

TPoint2D FeltObstacles::Thing::at(double aside) const {
  return anchor.T_map_base.composePoint(TPoint2D{side * reach, aside});
}

void FeltObstacles::feel(const Anchor& anchor, bool behind, const robot::RobotModel& model) {
  Thing thing{anchor, behind ? -1.0 : 1.0, 0.5 * model.length + kBeforeBody, kHalfBar, 1, Stamp::never()};
  for (const Thing& known : things_)
    if (distance(known.at(0.0), thing.at(0.0)) < config_.same_thing)
      thing.times = std::max(thing.times, known.times + 1);
  const bool for_good = thing.times >= config_.certain;
  thing.until = for_good ? kForGood : anchor.stamp + config_.memory * std::ldexp(1.0, thing.times - 1);
  things_.push_back(thing);
}

void FeltObstacles::passed(const TPose2D& T_map_base, const robot::RobotModel& model) {
  const double radius = 0.25 * model.width;
  things_.erase(std::remove_if(things_.begin(), things_.end(),
                               [&](const Thing& thing) {
                                 return distance(thing.at(0.0), {T_map_base.x, T_map_base.y}) < radius;
                               }),
                things_.end());
}

void FeltObstacles::follow(const slam::Mapper& mapper) {
  for (Thing& thing : things_) thing.anchor.follow(mapper);
}

std::vector<TPoint2D> FeltObstacles::points(Stamp now) const {
  std::vector<TPoint2D> points;
  for (const Thing& thing : things_) {
    if (now >= thing.until) continue;
    for (double aside = -thing.half_bar; aside < thing.half_bar + 0.5 * kBarStep; aside += kBarStep)
      points.push_back(thing.at(aside));
  }
  return points;
}

int FeltObstacles::count(Stamp now) const {
  return static_cast<int>(
      std::count_if(things_.begin(), things_.end(), [&](const Thing& thing) { return now < thing.until; }));
}

bool FeltObstacles::forget(Stamp now) {
  const bool any = count(now) > 0;
  for (Thing& thing : things_) thing.until = std::min(thing.until, now);
  return any;
}

bool FeltObstacles::pardon(Stamp now) {
  bool any = false;
  for (Thing& thing : things_) {
    if (now >= thing.until || thing.half_bar <= kNarrowBar) continue;
    thing.half_bar = kNarrowBar;
    any = true;
  }
  if (any) return true;
  for (Thing& thing : things_) {
    if (thing.until <= now || thing.times >= config_.certain) continue;
    thing.until = now;
    any = true;
  }
  return any;
}

}  // namespace rubble::explore
