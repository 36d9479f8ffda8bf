#include "explore/plan/traversable.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/distance_transform.h"
#include "base/planar.h"
#include "explore/plan/set_bytes.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using slam::CountMap;

constexpr int kWeakHits = 2;
constexpr double kLoneRadius = 0.15;  ///< [m]
constexpr double kStripWidth = 0.15;  ///< a strip of a veil, with what noise adds to it [m]
constexpr double kStripPitch = 0.3;   ///< from one to the next, one between them perhaps unseen [m]
constexpr double kRowBend = 1.5;      ///< off the line of their row [cells]
constexpr std::size_t kMostStrips = 2000;
constexpr std::size_t kStripsOfARow = 4;  ///< fewer are posts

/// A rectangle of cells, both corners inside it.
struct Box {
  Cell low;
  Cell high;
  bool empty() const { return high.x < low.x; }
};

/// Classifies cells by their counts. Branch-free and on plain arrays, so that compilers use vector code.
void classify_row(const std::uint16_t* __restrict seen, const std::uint16_t* __restrict hits, int count,
                  float threshold, Occupancy* __restrict cells, std::uint8_t* __restrict obstacle) {
  static_assert(static_cast<int>(Occupancy::Free) == 1 && static_cast<int>(Occupancy::Occupied) == 2);
  for (int i = 0; i < count; ++i) {
    const int known = seen[i] != 0;
    const int hit = hits[i] != 0;
    const int often = static_cast<float>(hits[i]) >= threshold * static_cast<float>(seen[i]);
    obstacle[i] = static_cast<std::uint8_t>(hit & often);
    cells[i] = static_cast<Occupancy>(known + (hit & often));
  }
}

/// Free of branches, so that compilers use vector code.
bool any_seen(const std::uint16_t* seen, int from, int to) {
  std::uint16_t any = 0;
  for (int x = from; x < to; ++x) any = static_cast<std::uint16_t>(any | seen[x]);
  return any != 0;
}

Box seen_box(const CountMap& map) {
  const GridFrame& frame = map.frame();
  Box box{{frame.width, frame.height}, {-1, -1}};
  for (int y = 0; y < frame.height; ++y) {
    const std::uint16_t* seen = map.seen_row(y);
    const bool left = any_seen(seen, 0, box.low.x);
    const bool middle = any_seen(seen, box.low.x, box.high.x + 1);
    const bool right = any_seen(seen, std::max(box.low.x, box.high.x + 1), frame.width);
    if (!left && !middle && !right) continue;
    box.low.y = std::min(box.low.y, y);
    box.high.y = y;
    if (left) box.low.x = static_cast<int>(std::find_if(seen, seen + box.low.x, [](auto n) { return n != 0; }) - seen);
    for (int x = frame.width - 1; (right || !middle) && x > box.high.x; --x)
      if (seen[x] != 0) box.high.x = x;
  }
  return box;
}

/// The cells within `reach` of p, cut to the inside of the rim.
Box cells_around(const GridFrame& frame, const TPoint2D& p, double reach) {
  const Cell low = frame.cell({p.x - reach, p.y - reach});
  const Cell high = frame.cell({p.x + reach, p.y + reach});
  return {{std::max(low.x, 1), std::max(low.y, 1)},
          {std::min(high.x, frame.width - 2), std::min(high.y, frame.height - 2)}};
}

bool stands_alone(const OccupancyGrid& cells, Cell c, int reach) {
  for (int y = std::max(c.y - reach, 0); y <= std::min(c.y + reach, cells.height() - 1); ++y)
    for (int x = std::max(c.x - reach, 0); x <= std::min(c.x + reach, cells.width() - 1); ++x)
      if (Cell{x, y} != c && cells[{x, y}] == Occupancy::Occupied) return false;
  return true;
}

bool has_obstacle(const Grid<std::uint8_t>& obstacle, const Box& box) {
  for (int y = box.low.y; y <= box.high.y; ++y)
    for (int x = box.low.x; x <= box.high.x; ++x)
      if (obstacle[{x, y}] != 0) return true;
  return false;
}

/// Occupied cells that belong together.
struct Thing {
  std::vector<Cell> cells;
  Box box;
  int longer_side() const { return std::max(box.high.x - box.low.x, box.high.y - box.low.y); }
  /// [cells]
  TPoint2D middle() const { return {0.5 * (box.low.x + box.high.x), 0.5 * (box.low.y + box.high.y)}; }
};

int cells_in(const Traversable& floor, double length) {
  return static_cast<int>(std::lround(length / std::max(floor.frame().resolution, 1e-9)));
}

/// What is occupied, cells up to `gap` apart in one thing; in the order of their first cells.
std::vector<Thing> things_of(const Traversable& floor, int gap) {
  const int width = floor.cells.width(), height = floor.cells.height();
  Grid<std::uint8_t> visited(floor.frame());
  std::vector<Thing> things;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (floor.cells[{x, y}] != Occupancy::Occupied || visited[{x, y}] != 0) continue;
      visited[{x, y}] = 1;
      Thing thing{{{x, y}}, {{x, y}, {x, y}}};
      for (std::size_t next = 0; next < thing.cells.size(); ++next) {
        const Cell c = thing.cells[next];
        for (int v = std::max(0, c.y - gap); v <= std::min(height - 1, c.y + gap); ++v)
          for (int u = std::max(0, c.x - gap); u <= std::min(width - 1, c.x + gap); ++u) {
            if (floor.cells[{u, v}] != Occupancy::Occupied || visited[{u, v}] != 0) continue;
            visited[{u, v}] = 1;
            thing.cells.push_back({u, v});
            thing.box = {{std::min(thing.box.low.x, u), std::min(thing.box.low.y, v)},
                         {std::max(thing.box.high.x, u), std::max(thing.box.high.y, v)}};
          }
      }
      things.push_back(std::move(thing));
    }
  return things;
}

/// Whether the laser has seen through between two strips: what lies on the line from one to the other is free.
bool seen_between(const OccupancyGrid& cells, const Thing& a, const Thing& b) {
  const TPoint2D from = a.middle(), way = b.middle() - from;
  const int steps = 2 * static_cast<int>(std::ceil(std::hypot(way.x, way.y)));
  const auto in = [](const Thing& t, Cell c) {
    return c.x >= t.box.low.x && c.x <= t.box.high.x && c.y >= t.box.low.y && c.y <= t.box.high.y;
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

/// Makes a thing free, as one that can be pushed.
void loosen(Traversable& floor, const Thing& thing) {
  for (const Cell c : thing.cells) {
    floor.cells[c] = Occupancy::Free;
    floor.obstacle[c] = 0;
  }
  floor.loose.insert(floor.loose.end(), thing.cells.begin(), thing.cells.end());
}

}  // namespace

Traversable traversable(OccupancyGrid known) {
  Traversable floor;
  floor.obstacle = Grid<std::uint8_t>(known.frame());
  floor.body = Grid<std::uint8_t>(known.frame());
  std::transform(known.cells().begin(), known.cells().end(), floor.obstacle.cells().begin(),
                 [](Occupancy o) { return static_cast<std::uint8_t>(o == Occupancy::Occupied); });
  floor.cells = std::move(known);
  return floor;
}

Traversable traversable(const CountMap& map, double occupied_threshold) {
  const Box box = seen_box(map);
  if (box.empty()) return {};
  const GridFrame& whole = map.frame();
  GridFrame frame = whole;
  frame.width = box.high.x - box.low.x + 3;
  frame.height = box.high.y - box.low.y + 3;
  frame.x0 = whole.x0 + (box.low.x - 1) * whole.resolution;
  frame.y0 = whole.y0 + (box.low.y - 1) * whole.resolution;

  Traversable floor;
  floor.cells = OccupancyGrid(frame, Occupancy::Unknown);
  floor.obstacle = Grid<std::uint8_t>(frame);
  floor.body = Grid<std::uint8_t>(frame);
  const float threshold = static_cast<float>(occupied_threshold);
  const int columns = frame.width - 2;
  std::vector<Cell> weak;
  for (int y = box.low.y; y <= box.high.y; ++y) {
    const int row = y - box.low.y + 1;
    const std::uint16_t* hits = map.occupied_row(y) + box.low.x;
    classify_row(map.seen_row(y) + box.low.x, hits, columns, threshold, floor.cells.row(row) + 1,
                 floor.obstacle.row(row) + 1);
    for_each_set(floor.obstacle.row(row), frame.width, [&](int x) {
      if (hits[x - 1] <= kWeakHits) weak.push_back({x, row});
    });
  }
  const int reach = static_cast<int>(std::lround(kLoneRadius / frame.resolution));
  for (const Cell c : weak)
    if (stands_alone(floor.cells, c, reach)) floor.obstacle[c] = 0;
  return floor;
}

void free_body(Traversable& floor, const TPose2D& T_map_base, double length, double width, double reach) {
  const GridFrame& frame = floor.frame();
  const double half_length = 0.5 * length + reach;
  const double half_width = 0.5 * width + reach;
  const double cos_phi = std::cos(T_map_base.phi);
  const double sin_phi = std::sin(T_map_base.phi);
  const Box box = cells_around(frame, {T_map_base.x, T_map_base.y}, rubble::length(half_length, half_width));
  for (int y = box.low.y; y <= box.high.y; ++y)
    for (int x = box.low.x; x <= box.high.x; ++x) {
      const TPoint2D p = frame.centre({x, y});
      const double dx = p.x - T_map_base.x;
      const double dy = p.y - T_map_base.y;
      if (std::abs(cos_phi * dx + sin_phi * dy) > half_length || std::abs(cos_phi * dy - sin_phi * dx) > half_width)
        continue;
      if (floor.cells[{x, y}] == Occupancy::Unknown) floor.body[{x, y}] = 1;
      floor.cells[{x, y}] = Occupancy::Free;
      floor.obstacle[{x, y}] = 0;
    }
}

void free_trail(Traversable& floor, const std::vector<TPoint2D>& trail, double radius) {
  const GridFrame& frame = floor.frame();
  for (const TPoint2D& passed : trail) {
    const Box box = cells_around(frame, passed, radius);
    for (int y = box.low.y; y <= box.high.y; ++y)
      for (int x = box.low.x; x <= box.high.x; ++x) {
        const Cell c{x, y};
        if (floor.cells[c] != Occupancy::Unknown) continue;
        const TPoint2D p = frame.centre(c);
        if (distance(p, passed) > radius) continue;
        floor.cells[c] = Occupancy::Free;
        floor.body[c] = 1;
      }
  }
}

void add_obstacles(Traversable& floor, const std::vector<TPoint2D>& points, double near) {
  const GridFrame& frame = floor.frame();
  std::vector<Cell> news;
  for (const TPoint2D& p : points) {
    const Cell c = frame.cell(p);
    if (!frame.inside(c) || floor.obstacle[c] != 0) continue;
    if (!has_obstacle(floor.obstacle, cells_around(frame, p, near))) news.push_back(c);
  }
  for (const Cell c : news) floor.obstacle[c] = 1;
}

bool free_small_things(Traversable& floor, double extent) {
  const int most = cells_in(floor, extent);
  bool any = false;
  for (const Thing& thing : things_of(floor, cells_in(floor, kLoneRadius))) {
    if (thing.longer_side() >= most) continue;
    loosen(floor, thing);
    any = true;
  }
  return any;
}

bool free_strips(Traversable& floor) {
  std::vector<Thing> strips = things_of(floor, 1);
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

void measure_clearance(Traversable& floor, double cap) { floor.clearance = distance_transform(floor.obstacle, cap); }

}  // namespace rubble::explore
