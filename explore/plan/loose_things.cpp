#include "explore/plan/loose_things.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>

#include "base/planar.h"
#include "explore/plan/set_bytes.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;

constexpr double kAlone = 0.15;       ///< nothing else is so near [m]
constexpr double kStripWidth = 0.15;  ///< a strip of a veil, with what noise adds to it [m]
constexpr double kStripPitch = 0.3;   ///< from one to the next, one between them perhaps unseen [m]
constexpr double kRowBend = 1.5;      ///< off the line of their row [cells]
constexpr std::size_t kMostStrips = 2000;
constexpr std::size_t kStripsOfARow = 4;  ///< fewer are posts

int cells_in(const Traversable& floor, double length) {
  return static_cast<int>(std::lround(length / std::max(floor.frame().resolution, 1e-9)));
}

/// Whether the laser has seen through between two strips: what lies on the line from one to the other is free.
bool seen_between(const OccupancyGrid& cells, const Thing& a, const Thing& b) {
  const TPoint2D from = a.middle(), way = b.middle() - from;
  const int steps = 2 * static_cast<int>(std::ceil(std::hypot(way.x, way.y)));
  const auto in = [](const Thing& t, Cell c) {
    return c.x >= t.low.x && c.x <= t.high.x && c.y >= t.low.y && c.y <= t.high.y;
  };
  bool gap = false;
  for (int i = 0; i <= steps; ++i) {
    const TPoint2D p = from + way * (static_cast<double>(i) / std::max(1, steps));
    const Cell c{static_cast<int>(std::lround(p.x)), static_cast<int>(std::lround(p.y))};
    if (in(a, c) || in(b, c)) continue;
    if (cells[c] != Occupancy::Free) return false;
    gap = true;
  }
  return gap;
}

/// The strips on the line through `a` and `b`, each no farther than `pitch` [cells] from the next and seen through
/// between; none when they are too few for a row.
std::vector<std::size_t> row_through(const OccupancyGrid& cells, const std::vector<Thing>& strips, std::size_t a,
                                     std::size_t b, double pitch) {
  const TPoint2D from = strips[a].middle(), way = strips[b].middle() - from;
  const double length = std::hypot(way.x, way.y);
  std::vector<std::pair<double, std::size_t>> along;  // cells behind `from`
  for (std::size_t i = 0; i < strips.size(); ++i) {
    const TPoint2D p = strips[i].middle() - from;
    if (std::abs(way.x * p.y - way.y * p.x) <= kRowBend * length)
      along.push_back({(way.x * p.x + way.y * p.y) / length, i});
  }
  std::sort(along.begin(), along.end());
  const auto mine = std::find_if(along.begin(), along.end(), [&](const auto& one) { return one.second == a; });
  auto first = mine, last = mine;
  const auto belong = [&](const auto& one, const auto& next) {
    return next->first - one->first <= pitch && seen_between(cells, strips[one->second], strips[next->second]);
  };
  while (first != along.begin() && belong(std::prev(first), first)) --first;
  while (std::next(last) != along.end() && belong(last, std::next(last))) ++last;
  std::vector<std::size_t> row;
  for (auto one = first; one <= last; ++one) row.push_back(one->second);
  if (row.size() < kStripsOfARow) row.clear();
  return row;
}

void make_free(Traversable& floor, const Thing& thing) {
  for (const Cell c : thing.cells) {
    floor.cells[c] = Occupancy::Free;
    floor.obstacle[c] = 0;
  }
}

}  // namespace

std::vector<Thing> things_of(const OccupancyGrid& cells, int gap) {
  const int width = cells.width(), height = cells.height();
  OccupancyGrid left = cells;  // what belongs to a thing is taken out
  std::vector<Thing> things;
  for (int y = 0; y < height; ++y)
    for_each_occupied(left.row(y), 0, width, [&](int x) {
      left[{x, y}] = Occupancy::Unknown;
      Thing thing{{{x, y}}, {x, y}, {x, y}};
      for (std::size_t next = 0; next < thing.cells.size(); ++next) {
        const Cell c = thing.cells[next];
        const int west = std::max(0, c.x - gap), east = std::min(width - 1, c.x + gap);
        for (int v = std::max(0, c.y - gap); v <= std::min(height - 1, c.y + gap); ++v) {
          Occupancy* const row = left.row(v);
          for (int u = west; u <= east; ++u) {
            if (row[u] != Occupancy::Occupied) continue;
            row[u] = Occupancy::Unknown;
            thing.cells.push_back({u, v});
            thing.low = {std::min(thing.low.x, u), std::min(thing.low.y, v)};
            thing.high = {std::max(thing.high.x, u), std::max(thing.high.y, v)};
          }
        }
      }
      things.push_back(std::move(thing));
    });
  return things;
}

void loosen(Traversable& floor, const Thing& thing) {
  make_free(floor, thing);
  floor.loose.insert(floor.loose.end(), thing.cells.begin(), thing.cells.end());
}

void doubt(Traversable& floor, const Thing& thing) {
  make_free(floor, thing);
  floor.doubtful.insert(floor.doubtful.end(), thing.cells.begin(), thing.cells.end());
}

bool free_small_things(Traversable& floor, double extent) {
  const int most = cells_in(floor, extent);
  bool any = false;
  for (const Thing& thing : things_of(floor.cells, cells_in(floor, kAlone))) {
    if (thing.longer_side() >= most) continue;
    loosen(floor, thing);
    any = true;
  }
  return any;
}

bool free_strips(Traversable& floor) {
  std::vector<Thing> strips = things_of(floor.cells, 1);
  const int most = cells_in(floor, kStripWidth);
  const double pitch = kStripPitch / std::max(floor.frame().resolution, 1e-9);
  strips.erase(std::remove_if(strips.begin(), strips.end(), [&](const Thing& t) { return t.longer_side() >= most; }),
               strips.end());
  if (strips.size() > kMostStrips) return false;  // noise; each is laid beside each
  std::vector<char> hangs(strips.size(), 0);
  for (std::size_t a = 0; a < strips.size(); ++a)
    for (std::size_t b = a + 1; b < strips.size(); ++b)
      if (distance(strips[a].middle(), strips[b].middle()) <= pitch)
        for (const std::size_t strip : row_through(floor.cells, strips, a, b, pitch)) hangs[strip] = 1;
  bool any = false;
  for (std::size_t i = 0; i < strips.size(); ++i) {
    if (hangs[i] == 0) continue;
    loosen(floor, strips[i]);
    any = true;
  }
  return any;
}

}  // namespace rubble::explore
