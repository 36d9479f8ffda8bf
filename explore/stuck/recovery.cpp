#include "explore/stuck/recovery.h"

#include <utility>

#include "base/planar.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kSamePlace = 0.5;  ///< [m]
constexpr double kLean = 0.03;      ///< getting free, the body may come so much closer to walls [m]
constexpr int kMostFailures = 10;   ///< in a row

}  // namespace

bool Recovery::begin(Escape::Met met, const TPose2D& T_map_base, Stamp now, std::optional<WayOut> way_out) {
  ++times_;
  const TPoint2D here = position(T_map_base);
  const bool again = place_ && distance(*place_, here) < kSamePlace;
  place_ = here;
  escape_.begin(met, T_map_base, now, failed_, std::move(way_out));
  return again;
}

Recovery::Result Recovery::step(const TPose2D& T_map_base, const robot::Drive& commanded, const StuckWatch& watch,
                                double dt, Stamp now, const Trail& trail, const Traversable& floor) {
  const auto room = [&](const TPose2D& pose) {
    const Cell c = floor.clearance.cell(position(pose));
    return !floor.clearance.inside(c) || floor.clearance[c] > 0.5 * model_.width - kLean;
  };
  switch (escape_.step(T_map_base, commanded, watch.stalled(), watch.wheels(), watch.struck(), dt, now, trail.points(),
                       way_back_, room)) {
    case Escape::Result::UnderWay:
      return Result::UnderWay;
    case Escape::Result::Free:
      failed_ = 0;
      return Result::Free;
    case Escape::Result::Failed:
      break;
  }
  return ++failed_ >= kMostFailures ? Result::Stuck : Result::Failed;
}

}  // namespace rubble::explore
