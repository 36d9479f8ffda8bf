#include "explore/paper/pushing.h"

#include <algorithm>
#include <utility>

#include "base/planar.h"
#include "explore/paper/off_grid.h"
#include "explore/plan/loose_things.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kPaper = 0.5;         ///< what stands alone and is not wider may be paper [m]
constexpr double kHeap = 1.1;          ///< several balls side by side; a panel of wall is 1.2 m wide [m]
constexpr double kPushReach = 1.0;     ///< things to be pushed aside are watched from here on [m]
constexpr double kHopeReach = 2.0;     ///< and what may be the floor of a slope: farther than any check of the way [m]
constexpr double kWall = 0.08;         ///< a hit so near to something of the map that is not loose is on that [m]
constexpr double kSeenOver = 0.6;      ///< floor of a slope is not seen from nearer: by then the robot is on it [m]
constexpr std::size_t kSolidHits = 3;  ///< fewer may be noise
constexpr double kRoll = 0.15;         ///< farther they do not roll between two looks [m]

}  // namespace

void Pushing::free_things(Traversable& floor, KnownGrids* known) const {
  if (slopes_only_) {
    free_off_grid(floor, pallet_, true, known);
    return;
  }
  if (on()) free_small_things(floor, what_ == What::Single ? kPaper : kHeap);
  if (what_ >= What::Strips) free_strips(floor);
  if (what_ == What::OffGrid) free_off_grid(floor, pallet_, false, known);
}

bool Pushing::worth(const Traversable& floor) const { return on() || known_then_.worth_a_try(floor); }

Pushing::What Pushing::start(const Traversable& floor) {
  if (!on()) known_then_.mark(floor);
  if (more()) what_ = static_cast<What>(static_cast<int>(what_) + 1);
  return what_;
}

/// The map shows loose things where they lay; as they roll, what is seen near where they were just now is they.
std::vector<TPoint2D> Pushing::without_loose_things(const std::vector<TPoint2D>& hits, const TPose2D& T_map_base,
                                                    const Traversable& floor) {
  const TPoint2D here = position(T_map_base);
  std::vector<TPoint2D> loose = std::move(rolling_);
  rolling_.clear();
  solid_.clear();
  near_ = false;
  if (!on() && floor.doubtful.empty()) return hits;
  std::vector<TPoint2D> doubtful;
  const auto add_near = [&](const std::vector<Cell>& cells, double reach, std::vector<TPoint2D>& points) {
    for (const Cell c : cells)
      if (const TPoint2D p = floor.cells.centre(c); distance(p, here) < reach) points.push_back(p);
  };
  add_near(floor.loose, kPushReach, loose);
  add_near(floor.doubtful, kHopeReach, doubtful);
  std::vector<TPoint2D> rest, met;
  for (const TPoint2D& hit : hits) {
    const Cell c = floor.clearance.cell(hit);
    const bool wall = floor.clearance.inside(c) && floor.clearance[c] < kWall;
    const double away = distance(hit, here);
    const auto on = [&](const std::vector<TPoint2D>& points) {
      return std::any_of(points.begin(), points.end(), [&](const auto& p) { return distance(p, hit) < kRoll; });
    };
    if (!wall && away < kPushReach && on(loose))
      rolling_.push_back(hit);
    else if (wall || away >= kHopeReach || !on(doubtful))
      rest.push_back(hit);
    else if (away < kSeenOver)
      met.push_back(hit);
    else
      near_ = near_ || away < kPushReach;
  }
  near_ = near_ || !rolling_.empty();
  rest.insert(rest.end(), met.begin(), met.end());
  if (met.size() < kSolidHits) return rest;
  for (const TPoint2D& p : doubtful)
    if (std::any_of(met.begin(), met.end(), [&](const TPoint2D& hit) { return distance(hit, p) < kRoll; }))
      solid_.push_back(p);
  return rest;
}

}  // namespace rubble::explore
