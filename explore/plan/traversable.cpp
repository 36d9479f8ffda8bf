#include "explore/plan/traversable.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/distance_transform.h"
#include "base/planar.h"
#include "explore/plan/box_sides.h"
#include "explore/plan/set_bytes.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using slam::CountMap;

constexpr int kWeakHits = 2;
constexpr int kSeenOverHits = 5;      ///< fewer are noise, or the error of a pose beside a wall
constexpr int kSeenOverPasses = 10;   ///< likewise so many scans to a hit
constexpr double kOneWay = 0.5;       ///< places of a trail farther apart are not one way: the map moved between [m]
constexpr float kSure = 0.85f;        ///< of the scans that looked at a wall so many hit it, at least
constexpr double kLoneRadius = 0.15;  ///< [m]

/// A rectangle of cells, both corners inside it.
struct Box {
  Cell low;
  Cell high;
  bool empty() const { return high.x < low.x; }
};

/// Classifies cells by their counts. Branch-free and on plain arrays, so that compilers use vector code.
void classify_row(const std::uint16_t* __restrict seen, const std::uint16_t* __restrict hits, int count,
                  float threshold, Occupancy* __restrict cells, std::uint8_t* __restrict obstacle,
                  std::uint8_t* __restrict seen_over, std::uint8_t* __restrict unsure, std::uint8_t* __restrict scans) {
  static_assert(static_cast<int>(Occupancy::Free) == 1 && static_cast<int>(Occupancy::Occupied) == 2);
  for (int i = 0; i < count; ++i) {
    const int known = seen[i] != 0;
    const int hit = hits[i] != 0;
    const int often = static_cast<float>(hits[i]) >= threshold * static_cast<float>(seen[i]);
    const int some = (hits[i] >= kSeenOverHits) & (kSeenOverPasses * hits[i] >= seen[i]);
    obstacle[i] = static_cast<std::uint8_t>(hit & often);
    const int sure = static_cast<float>(hits[i]) >= kSure * static_cast<float>(seen[i]);
    seen_over[i] = static_cast<std::uint8_t>(some & ~often);
    unsure[i] = static_cast<std::uint8_t>(hit & often & ~sure);
    cells[i] = static_cast<Occupancy>(known + (hit & often));
    scans[i] = static_cast<std::uint8_t>(std::min<std::uint16_t>(seen[i], 255));
  }
}

Box seen_box(const CountMap& map) {
  const GridFrame& frame = map.frame();
  Box box{{frame.width, frame.height}, {-1, -1}};
  for (int y = 0; y < frame.height; ++y)
    map.for_seen(y, 0, frame.width, [&](int x, int count, const std::uint16_t* seen, const std::uint16_t*) {
      const bool inside = box.low.x <= x && x + count <= box.high.x + 1;  // no news but of the row
      const auto known = [](std::uint16_t n) { return n != 0; };
      const std::uint16_t* const first = std::find_if(seen, seen + count, known);
      if (first == seen + count) return;
      box.low.y = std::min(box.low.y, y);
      box.high.y = y;
      if (inside) return;
      const auto last = std::find_if(std::make_reverse_iterator(seen + count), std::make_reverse_iterator(seen), known);
      box.low.x = std::min(box.low.x, x + static_cast<int>(first - seen));
      box.high.x = std::max(box.high.x, x + static_cast<int>(last.base() - seen) - 1);
    });
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

/// Calls `use` with each cell within `radius` of one of the places that is `wanted`, for each of them. Few are, so that
/// is asked first: of a long trail most cells are known already, and their distances need not be taken.
template <typename Wanted, typename Use>
void for_cells_near(const GridFrame& frame, const std::vector<TPoint2D>& places, double radius, const Wanted& wanted,
                    const Use& use) {
  for (const TPoint2D& p : places) {
    const Box box = cells_around(frame, p, radius);
    for (int y = box.low.y; y <= box.high.y; ++y)
      for (int x = box.low.x; x <= box.high.x; ++x)
        if (wanted(frame.index({x, y})) && distance(frame.centre({x, y}), p) <= radius) use(Cell{x, y});
  }
}

}  // namespace

Traversable traversable(OccupancyGrid known) {
  Traversable floor;
  floor.obstacle = Grid<std::uint8_t>(known.frame());
  floor.body = floor.seen_over = floor.unsure = floor.solid = floor.scans = Grid<std::uint8_t>(known.frame());
  std::transform(known.cells().begin(), known.cells().end(), floor.obstacle.cells().begin(),
                 [](Occupancy o) { return static_cast<std::uint8_t>(o == Occupancy::Occupied); });
  floor.cells = std::move(known);
  return floor;
}

Traversable traversable(const CountMap& map, double occupied_threshold, bool low_walls) {
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
  floor.body = floor.seen_over = floor.unsure = floor.solid = floor.scans = Grid<std::uint8_t>(frame);
  const float threshold = static_cast<float>(occupied_threshold);
  std::vector<Cell> weak;
  for (int y = box.low.y; y <= box.high.y; ++y) {
    const int row = y - box.low.y + 1;
    map.for_seen(y, box.low.x, box.high.x + 1,
                 [&](int x, int count, const std::uint16_t* seen, const std::uint16_t* hits) {
                   const int column = x - box.low.x + 1;
                   classify_row(seen, hits, count, threshold, floor.cells.row(row) + column,
                                floor.obstacle.row(row) + column, floor.seen_over.row(row) + column,
                                floor.unsure.row(row) + column, floor.scans.row(row) + column);
                 });
    for_each_set(floor.obstacle.row(row), frame.width, [&](int x) {
      if (map.occupied({x - 1 + box.low.x, y}) <= kWeakHits) weak.push_back({x, row});
    });
  }
  if (low_walls)
    keep_box_sides(floor.seen_over);
  else
    floor.seen_over = Grid<std::uint8_t>(frame);
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
  const Occupancy* const cells = floor.cells.data();
  for_cells_near(
      floor.frame(), trail, radius, [&](std::size_t i) { return cells[i] == Occupancy::Unknown; },
      [&](Cell c) {
        floor.cells[c] = Occupancy::Free;
        floor.body[c] = 1;
      });
}

void loosen_trail(Traversable& floor, const std::vector<TPoint2D>& trail, double radius) {
  const Occupancy* const cells = floor.cells.data();
  const std::uint8_t* const obstacle = floor.obstacle.data();
  for_cells_near(
      floor.frame(), trail, radius, [&](std::size_t i) { return cells[i] == Occupancy::Occupied || obstacle[i] != 0; },
      [&](Cell c) {
        floor.cells[c] = Occupancy::Free;
        floor.obstacle[c] = 0;
        floor.loose.push_back(c);
      });
}

void widen_trail(Traversable& floor, const std::vector<TPoint2D>& trail, double clearance,
                 const std::vector<TPoint2D>& things) {
  const double cell = floor.frame().resolution;
  const auto room = static_cast<float>(clearance);
  const auto widen = [&](const TPoint2D& p) {
    if (std::any_of(things.begin(), things.end(), [&](const TPoint2D& q) { return distance(p, q) < clearance; }))
      return;
    const Box box = cells_around(floor.frame(), p, 1.5 * cell);
    for (int y = box.low.y; y <= box.high.y; ++y)
      for (int x = box.low.x; x <= box.high.x; ++x)
        if (floor.obstacle[{x, y}] == 0) floor.clearance[{x, y}] = std::max(floor.clearance[{x, y}], room);
  };
  for (std::size_t i = 0; i + 1 < trail.size(); ++i) {
    const TPoint2D way = trail[i + 1] - trail[i];
    const double apart = length(way.x, way.y);
    if (apart > kOneWay) continue;
    const int steps = std::max(1, static_cast<int>(std::ceil(apart / cell)));
    for (int k = 0; k <= steps; ++k) widen(trail[i] + way * (static_cast<double>(k) / steps));
  }
}

void keep_to_trail(Traversable& floor, const std::vector<TPoint2D>& trail, double radius) {
  OccupancyGrid kept(floor.frame(), Occupancy::Unknown);
  const double reach = radius / floor.frame().resolution;
  for (const TPoint2D& p : trail) {
    const Cell middle = floor.cells.cell(p);
    const Box box = cells_around(floor.frame(), p, radius);
    for (int y = box.low.y; y <= box.high.y; ++y)
      for (int x = box.low.x; x <= box.high.x; ++x) {
        const double dx = x - middle.x, dy = y - middle.y;
        if (dx * dx + dy * dy <= reach * reach) kept[{x, y}] = floor.cells[{x, y}];
      }
  }
  for (int y = 0; y < floor.cells.height(); ++y)
    for (int x = 0; x < floor.cells.width(); ++x)
      if (floor.cells[{x, y}] == Occupancy::Free) floor.cells[{x, y}] = kept[{x, y}];
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

void measure_clearance(Traversable& floor, double cap) { floor.clearance = distance_transform(floor.obstacle, cap); }

}  // namespace rubble::explore
