#include "explore/stuck/recovery.h"

#include <algorithm>
#include <utility>

#include "base/planar.h"
#include "robot/body.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kSamePlace = 0.5;    ///< [m]
constexpr double kWallsWithin = 0.5;  ///< [m]
constexpr double kLean = 0.03;        ///< getting free, the body may come so much closer to walls [m]
constexpr int kMostFailures = 10;     ///< in a row

}  // namespace

bool Recovery::begin(Escape::Met met, const TPose2D& T_map_base, Stamp now, std::optional<WayOut> way_out) {
  ++times_;
  const TPoint2D here = position(T_map_base);
  const bool again = place_ && distance(place_->p_map(), here) < kSamePlace;
  place_.emplace(Anchor{now, T_map_base}, here);
  escape_.begin(met, T_map_base, now, failed_, std::move(way_out));
  return again;
}

/// Between the body in a pose and the nearest wall of the map.
double Recovery::gap_to_walls(const TPose2D& pose, const Traversable& floor) const {
  const PlanarTransform T(pose);
  const double radius = 0.5 * floor.frame().resolution;
  double least = kWallsWithin;
  const Cell low = floor.cells.cell({pose.x - kWallsWithin, pose.y - kWallsWithin});
  const Cell high = floor.cells.cell({pose.x + kWallsWithin, pose.y + kWallsWithin});
  for (int y = std::max(0, low.y); y <= std::min(floor.cells.height() - 1, high.y); ++y)
    for (int x = std::max(0, low.x); x <= std::min(floor.cells.width() - 1, high.x); ++x) {
      if (floor.cells[{x, y}] != Occupancy::Occupied) continue;
      const TPoint2D p = T.inverse(floor.cells.centre({x, y}));
      least = std::min(least, robot::to_body(model_, p.x, p.y) - radius);
    }
  return least;
}

Recovery::Result Recovery::step(const TPose2D& T_map_base, const robot::Drive& commanded, const StuckWatch& watch,
                                double dt, Stamp now, const Trail& trail, const Traversable& floor) {
  const auto room = [&](const TPose2D& pose) {
    const Cell c = floor.clearance.cell(position(pose));
    return !floor.clearance.inside(c) || floor.clearance[c] > 0.5 * model_.width - kLean;
  };
  const auto gap = [&](const TPose2D& pose) { return gap_to_walls(pose, floor); };
  switch (escape_.step(T_map_base, commanded, watch.stalled(), watch.wheels(), watch.struck(), dt, now, trail.points(),
                       way_back_, {room, gap})) {
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
