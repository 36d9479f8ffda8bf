#include "explore/paper/close_looks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "base/angle.h"
#include "base/planar.h"
#include "explore/caution/local_grids.h"
#include "explore/caution/pallet_grid.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kNearLaser = 1.3;          ///< [m]
constexpr std::size_t kMostLooks = 40;      ///< kept
constexpr int kEnough = 5;                  ///< looks that agree
constexpr int kAgainstOne = 10;             ///< looks count, one that says otherwise
constexpr double kAside = deg_to_rad(1.0);  ///< rays so near to a bearing go there [rad]
constexpr double kOnIt = 0.1;               ///< a hit so near in range is on it [m]
constexpr double kBody = 0.3;               ///< so much of a wall has to be passed over, in a row of cells [m]
constexpr double kSame = 0.004;             ///< places so near are one; less than a cell of the finest map [m]
constexpr double kPastIt = 0.2;             ///< one so much farther passed over it [m]

}  // namespace

void CloseLooks::look(const std::vector<TPoint2D>& hits, const TPose2D& T_map_base) {
  if (pallet_ <= 0.0) return;
  Look look;
  look.origin = T_map_base.composePoint(p_base_laser_);
  for (const TPoint2D& hit : hits) {
    const TPoint2D ray = hit - look.origin;
    look.rays.push_back({std::atan2(ray.y, ray.x), length(ray)});
  }
  std::sort(look.rays.begin(), look.rays.end(),
            [](const Look::Ray& a, const Look::Ray& b) { return a.bearing < b.bearing; });
  looks_.push_back(std::move(look));
  if (looks_.size() > kMostLooks) looks_.pop_front();
}

CloseLooks::Verdict CloseLooks::seen(const Look& look, const TPoint2D& p_map) {
  const TPoint2D way = p_map - look.origin;
  const double away = length(way);
  const double bearing = std::atan2(way.y, way.x);
  bool before = false, on = false, past = false;
  for (const double turn : {0.0, -2.0 * kPi, 2.0 * kPi}) {
    const auto first = std::lower_bound(look.rays.begin(), look.rays.end(), bearing + turn - kAside,
                                        [](const Look::Ray& ray, double value) { return ray.bearing < value; });
    for (auto ray = first; ray != look.rays.end() && ray->bearing <= bearing + turn + kAside; ++ray) {
      const double beyond = ray->range - away;
      before = before || beyond <= -kOnIt;
      on = on || std::abs(beyond) < kOnIt;
      past = past || beyond > kPastIt;
    }
  }
  if (before) return Verdict::Open;  // something hides it
  return on ? Verdict::Solid : past ? Verdict::Floor : Verdict::Open;
}

CloseLooks::Verdict CloseLooks::judge(const TPoint2D& p_map) const {
  int over = 0, met = 0;
  for (const Look& look : looks_) {
    const Verdict seen = CloseLooks::seen(look, p_map);
    over += seen == Verdict::Floor ? 1 : 0;
    met += seen == Verdict::Solid ? 1 : 0;
  }
  if (over >= kEnough && over >= kAgainstOne * met) return Verdict::Floor;
  return met >= kEnough && met >= kAgainstOne * over ? Verdict::Solid : Verdict::Open;
}

CloseLooks::Verdict CloseLooks::judge(const Traversable& floor, const Anchor& robot) {
  Verdict verdict = Verdict::Open;
  if (looks_.empty()) return verdict;
  const TPoint2D laser = robot.T_map_base.composePoint(p_base_laser_);
  LocalGrids grids(floor.cells, pallet_);
  std::vector<TPoint2D> over;
  const Cell low = floor.cells.cell({laser.x - kNearLaser, laser.y - kNearLaser});
  const Cell high = floor.cells.cell({laser.x + kNearLaser, laser.y + kNearLaser});
  for (int y = std::max(0, low.y); y <= std::min(floor.cells.height() - 1, high.y); ++y)
    for (int x = std::max(0, low.x); x <= std::min(floor.cells.width() - 1, high.x); ++x) {
      const TPoint2D p = floor.cells.centre({x, y});
      // What is solid stays so: it would be found to be floor again and again.
      if (floor.cells[{x, y}] != Occupancy::Occupied || floor.solid[{x, y}] != 0 || distance(p, laser) > kNearLaser)
        continue;
      const std::optional<PalletGrid>& grid = grids.at(p);
      if (floor.unsure[{x, y}] == 0 && !(grid && grid->depth(p) > kOnAnEdge)) continue;
      const Verdict here = judge(p);
      if (here == Verdict::Floor) over.push_back(p);
      if (here != Verdict::Solid) continue;
      solid_.emplace_back(robot, p);
      verdict = Verdict::Solid;
    }
  if (static_cast<double>(over.size()) * floor.frame().resolution < kBody) return verdict;
  for (const TPoint2D& p : over) floor_.emplace_back(robot, p);
  return Verdict::Floor;
}

void CloseLooks::met(const std::vector<TPoint2D>& places, const Anchor& robot) {
  for (const TPoint2D& p : places) {
    const bool known = std::any_of(solid_.begin(), solid_.end(),
                                   [&](const AnchoredPoint& point) { return distance(point.p_map(), p) < kSame; });
    if (!known) solid_.emplace_back(robot, p);
  }
}

void CloseLooks::apply(Traversable& floor) const {
  for (const AnchoredPoint& point : solid_) {
    const Cell c = floor.cells.cell(point.p_map());
    for (int y = std::max(0, c.y - 1); y <= std::min(floor.cells.height() - 1, c.y + 1); ++y)
      for (int x = std::max(0, c.x - 1); x <= std::min(floor.cells.width() - 1, c.x + 1); ++x) floor.solid[{x, y}] = 1;
  }
  for (const AnchoredPoint& point : floor_) {
    const Cell c = floor.cells.cell(point.p_map());
    if (!floor.cells.inside(c) || floor.cells[c] != Occupancy::Occupied || floor.solid[c] != 0) continue;
    floor.cells[c] = Occupancy::Free;
    floor.obstacle[c] = 0;
    floor.doubtful.push_back(c);
  }
}

void CloseLooks::follow(const slam::Mapper& mapper) {
  looks_.clear();
  for (AnchoredPoint& point : floor_) point.follow(mapper);
  for (AnchoredPoint& point : solid_) point.follow(mapper);
}

}  // namespace rubble::explore
