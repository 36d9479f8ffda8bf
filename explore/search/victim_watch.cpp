#include "explore/search/victim_watch.h"

#include <algorithm>
#include <cmath>

#include "base/planar.h"
#include "base/wall_between.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kCueAge = 1.2;    ///< an unconfirmed cue younger than this is worth waiting for [s]
constexpr double kOfVictim = 0.5;  ///< a cue so near to a confirmed victim is of it [m]
constexpr double kBehind = 0.08;   ///< a victim lies so far behind the wall, not before it or in its cells [m]
constexpr double kHand = 0.12;     ///< beside a line of sight through a hole there is wall [m]
constexpr int kSureOfHoles = 3;    ///< cues

/// Whether a wall stands between, at least kBehind before `to`.
bool is_behind_wall(const Traversable& floor, const TPoint2D& from, const TPoint2D& to) {
  const TPoint2D way = to - from;
  const double length = way.norm();
  return length > kBehind && wall_between(floor.cells, from, from + way * ((length - kBehind) / length));
}

/// The same, and not past the edge of that wall: seen aslant, the side of a box covers what lies in it on the map, by a
/// cell or by the error of the place, and a hand beside the line there is no wall.
bool is_within_wall(const Traversable& floor, const TPoint2D& from, const TPoint2D& to) {
  if (!is_behind_wall(floor, from, to)) return false;
  const TPoint2D way = to - from;
  const TPoint2D aside = TPoint2D{-way.y, way.x} * (kHand / way.norm());
  return is_behind_wall(floor, from + aside, to + aside) && is_behind_wall(floor, from - aside, to - aside);
}

}  // namespace

bool VictimWatch::hear(const robot::VictimCue& cue, const slam::Mapper& mapper, const TPose2D& T_map_base,
                       const Traversable& floor) {
  if (doubt_.unsure()) return false;
  const Anchor anchor{cue.stamp, mapper.pose_at(cue.stamp).value_or(T_map_base)};
  const auto same_side = [&](const TPoint2D& a, const TPoint2D& b) {
    const Cell from = floor.cells.cell(a);
    const Cell to = floor.cells.cell(b);
    if (!floor.cells.inside(from) || !floor.cells.inside(to)) return true;
    return in_sight(floor, from, to);
  };
  const std::size_t before = victims_.reports().size();
  const auto hidden = [&](const TPoint2D& from, const TPoint2D& to) { return is_behind_wall(floor, from, to); };
  victims_.add(cue, anchor, {same_side, hidden});
  ask_for_holes(anchor,
                anchor.T_map_base.composePoint({cue.range * std::cos(cue.bearing), cue.range * std::sin(cue.bearing)}),
                floor);
  return victims_.reports().size() > before;
}

/// A victim in a niche lies before its back, though a cue past the niche's edge may seem to come through it; one that
/// is seen behind a wall again and again, and hardly ever before it, is seen through a hole.
void VictimWatch::ask_for_holes(const Anchor& anchor, const TPoint2D& cue, const Traversable& floor) {
  const auto away = [&](const VictimReport& victim) { return distance(victim.p_map, cue); };
  const auto victim = std::min_element(reports().begin(), reports().end(),
                                       [&](const VictimReport& a, const VictimReport& b) { return away(a) < away(b); });
  if (victim == reports().end() || away(*victim) > kOfVictim) return;
  Cues& cues = cues_[victim->id];
  ++(is_within_wall(floor, position(anchor.T_map_base), victim->p_map) ? cues.through_wall : cues.in_sight);
  if (cues.through_wall >= kSureOfHoles && cues.through_wall > 2 * cues.in_sight) search_.expect_holes();
}

bool VictimWatch::look(const Traversable& floor, const TPose2D& T_map_base, double turn_rate, Stamp now) {
  return !doubt_.unsure() && search_.look(floor, T_map_base, turn_rate, now);
}

bool VictimWatch::holds_still(const Traversable& floor, const TPose2D& T_map_base, Stamp now) {
  return search_.staring(victims_.undecided(now, kCueAge), now) || search_.dwelling(floor, T_map_base, now);
}

bool VictimWatch::follow(const slam::Mapper& mapper) {
  victims_.follow(mapper);
  return search_.follow(mapper);
}

}  // namespace rubble::explore
