#include "explore/search/behind_wall.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/planar.h"
#include "base/wall_between.h"
#include "explore/search/searched_area.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using slam::CountMap;

constexpr double kBehind = 0.08;     ///< a victim lies so far behind the wall, not before it or in its cells [m]
constexpr double kHand = 0.12;       ///< beside a line of sight through a hole there is wall [m]
constexpr double kBoxDepth = 0.6;    ///< what lies in a box behind a hole is not farther from it [m]
constexpr double kPanel = 0.9;       ///< walls are at least so long, but for what the map lacks at their ends [m]
constexpr double kHits = 0.85;       ///< of the scans that looked at a wall so many hit it, at least
constexpr double kAround = 1.0;      ///< of a line of sight, where its wall is looked for [m]
constexpr double kFarthest = 10.0;   ///< no camera tells of a victim from farther away [m]
constexpr int kWallDirections = 16;  ///< that walls may have
constexpr double kFlattest = 0.866;  ///< cosine: a wall that is looked through more aslant than by 30 deg is none

/// The part of a map around a line.
OccupancyGrid around(const OccupancyGrid& cells, const TPoint2D& a, const TPoint2D& b) {
  const Cell low = cells.cell({std::min(a.x, b.x) - kAround, std::min(a.y, b.y) - kAround});
  const Cell high = cells.cell({std::max(a.x, b.x) + kAround, std::max(a.y, b.y) + kAround});
  GridFrame frame = cells.frame();
  frame.x0 += low.x * frame.resolution;
  frame.y0 += low.y * frame.resolution;
  frame.width = high.x - low.x + 1;
  frame.height = high.y - low.y + 1;
  OccupancyGrid part(frame);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x)
      if (const Cell c{low.x + x, low.y + y}; cells.inside(c)) part[{x, y}] = cells[c];
  return part;
}

bool is_wall(const OccupancyGrid& cells, const TPoint2D& p) {
  const Cell c = cells.cell(p);
  return cells.inside(c) && cells[c] == Occupancy::Occupied;
}

/// A straight piece of wall.
struct Panel {
  double length = 0.0;  ///< [m]
  int seen = 0;         ///< of its cells the counts, but for those of holes that were seen
  int hits = 0;
};

void count(Panel& panel, const CountMap& counts, const TPoint2D& p) {
  const Cell c = counts.frame().cell(p);
  if (c.x < 0 || c.y < 0 || c.x >= counts.frame().width || c.y >= counts.frame().height) return;
  if (2 * counts.occupied(c) < counts.seen(c)) return;
  panel.seen += counts.seen(c);
  panel.hits += counts.occupied(c);
}

/// Goes on along a wall from `p`, for a panel's length; two cells may be missing.
void follow(Panel& panel, const OccupancyGrid& cells, const CountMap* counts, const TPoint2D& p,
            const TPoint2D& direction) {
  const double step = 0.5 * cells.frame().resolution;
  double last = 0.0;
  for (double way = 0.0; way <= kPanel && way - last <= 5.0 * step; way += step) {
    if (!is_wall(cells, p + direction * way)) continue;
    last = way;
    if (counts != nullptr) count(panel, *counts, p + direction * way);
  }
  panel.length += last;
}

/// Whether a wall runs through `p` across a line of sight of this direction.
bool in_panel(const OccupancyGrid& cells, const CountMap* counts, const TPoint2D& p, const TPoint2D& sight) {
  for (int i = 0; i < kWallDirections; ++i) {
    const TPoint2D along(std::cos(kPi * i / kWallDirections), std::sin(kPi * i / kWallDirections));
    if (std::abs(along.x * sight.x + along.y * sight.y) > kFlattest) continue;
    Panel panel;
    follow(panel, cells, counts, p, along);
    follow(panel, cells, counts, p, along * -1.0);
    if (panel.length >= kPanel && panel.hits >= kHits * panel.seen && (counts == nullptr || panel.seen > 0))
      return true;
  }
  return false;
}

}  // namespace

bool is_behind_wall(const OccupancyGrid& cells, const TPoint2D& from, const TPoint2D& to) {
  const TPoint2D way = to - from;
  const double length = way.norm();
  return length > kBehind && wall_between(cells, from, from + way * ((length - kBehind) / length));
}

bool is_within_wall(const OccupancyGrid& cells, const TPoint2D& from, const TPoint2D& to) {
  if (!is_behind_wall(cells, from, to)) return false;
  const TPoint2D way = to - from;
  const TPoint2D aside = TPoint2D{-way.y, way.x} * (kHand / way.norm());
  return is_behind_wall(cells, from + aside, to + aside) && is_behind_wall(cells, from - aside, to - aside);
}

bool is_behind_hole(const OccupancyGrid& shut, const CountMap* counts, const TPoint2D& from, const TPoint2D& to) {
  if (!is_within_wall(shut, from, to)) return false;
  const double length = distance(from, to);
  const TPoint2D back = (from - to) * (1.0 / length);
  const double step = 0.5 * shut.frame().resolution;
  for (double way = kBehind; way <= std::min(kBoxDepth, length); way += step)
    if (is_wall(shut, to + back * way) && in_panel(shut, counts, to + back * way, back)) return true;
  return false;
}

bool shows_through_hole(const OccupancyGrid& cells, const TPoint2D& from, const TPoint2D& to) {
  if (!(distance(from, to) < kFarthest)) return false;
  return is_behind_hole(with_holes_shut(around(cells, from, to)), nullptr, from, to);
}

}  // namespace rubble::explore
