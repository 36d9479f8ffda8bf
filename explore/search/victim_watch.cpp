#include "explore/search/victim_watch.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kCueAge = 1.2;  ///< an unconfirmed cue younger than this is worth waiting for [s]

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
  victims_.add(cue, anchor, same_side);
  return victims_.reports().size() > before;
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
