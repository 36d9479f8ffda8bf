#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/scoring_schemes.h"

/// Schemes of a team that knows how arenas are built, or what the score asks: pallets completed, floor inferred, fans
/// of free ground, coarse cells, fat pencils over doubts, walls alone, two drawings of which one is bad.
namespace rubble::scoring::testing {

/// What a map says of the edges of the lattice over what `truth` knows, and of the floor of its pallets.
class Pallets {
 public:
  enum class Edge { Unseen, Open, Wall };

  Pallets(const OccupancyGrid& map, const OccupancyGrid& truth) : map_(map) {
    const GridFrame known = known_frame(truth, 0.0).value_or(truth.frame());
    x0_ = known.x0 + 0.5 * truth.resolution();
    y0_ = known.y0 + 0.5 * truth.resolution();
    columns = std::max(1, static_cast<int>(std::lround(known.width * known.resolution / kLattice)));
    rows = std::max(1, static_cast<int>(std::lround(known.height * known.resolution / kLattice)));
  }
  TPoint2D node(int x, int y) const { return {x0_ + x * kLattice, y0_ + y * kLattice}; }
  /// A wall or open where the map knows `least` (a share) of it.
  Edge edge(const TPoint2D& a, const TPoint2D& b, double least) const {
    constexpr int kAsked = 11;
    int wall = 0;
    int open = 0;
    for (int i = 1; i < kAsked; ++i) {
      const Occupancy there = around(a + (b - a) * (static_cast<double>(i) / kAsked));
      wall += there == Occupancy::Occupied ? 1 : 0;
      open += there == Occupancy::Free ? 1 : 0;
    }
    if (wall + open < least * (kAsked - 1)) return Edge::Unseen;
    return wall > open ? Edge::Wall : Edge::Open;
  }
  /// Walls and ways of pallet (x, y) that are known: west, east, south, north.
  std::vector<Edge> around_pallet(int x, int y, double least) const {
    return {edge(node(x, y), node(x, y + 1), least), edge(node(x + 1, y), node(x + 1, y + 1), least),
            edge(node(x, y), node(x + 1, y), least), edge(node(x, y + 1), node(x + 1, y + 1), least)};
  }
  int columns = 0;
  int rows = 0;

 private:
  /// The wall within a cell of the place, else what is there.
  Occupancy around(const TPoint2D& p) const {
    const Cell c = map_.cell(p);
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (map_.inside({c.x + dx, c.y + dy}) && map_[{c.x + dx, c.y + dy}] == Occupancy::Occupied)
          return Occupancy::Occupied;
    return map_.inside(c) ? map_[c] : Occupancy::Unknown;
  }

  const OccupancyGrid& map_;
  double x0_ = 0.0;
  double y0_ = 0.0;
};

/// Unknown ground along every edge of the lattice of which `least` is known becomes what the rest of the edge is; with
/// `floors`, that of pallets with a known edge becomes free.
inline OccupancyGrid with_whole_pallets(const OccupancyGrid& map, const OccupancyGrid& truth, double least,
                                        bool floors) {
  const Pallets pallets(map, truth);
  OccupancyGrid walls(map.frame());
  OccupancyGrid floor(map.frame());
  const auto lay = [&](const TPoint2D& a, const TPoint2D& b) {
    const Pallets::Edge edge = pallets.edge(a, b, least);
    if (edge == Pallets::Edge::Wall) draw_wall(walls, a, b, 2);
    if (edge == Pallets::Edge::Open && floors) draw_wall(floor, a, b, 4);
  };
  const auto free_floor = [&](const TPoint2D& low) {
    for (double y = 0.1; y < kLattice - 0.05; y += 0.5 * map.resolution())
      for (double x = 0.1; x < kLattice - 0.05; x += 0.5 * map.resolution()) {
        const Cell c = floor.cell(low + TPoint2D(x, y));
        if (floor.inside(c)) floor[c] = Occupancy::Occupied;  // turned to free below
      }
  };
  for (int y = 0; y <= pallets.rows; ++y)
    for (int x = 0; x <= pallets.columns; ++x) {
      if (x < pallets.columns) lay(pallets.node(x, y), pallets.node(x + 1, y));
      if (y < pallets.rows) lay(pallets.node(x, y), pallets.node(x, y + 1));
      if (!floors || x == pallets.columns || y == pallets.rows) continue;
      const std::vector<Pallets::Edge> edges = pallets.around_pallet(x, y, least);
      if (std::count(edges.begin(), edges.end(), Pallets::Edge::Unseen) < 3) free_floor(pallets.node(x, y));
    }
  for (std::size_t i = 0; i < floor.cells().size(); ++i)
    if (walls.cells()[i] == Occupancy::Unknown && floor.cells()[i] == Occupancy::Occupied)
      walls.cells()[i] = Occupancy::Free;
  return filled(map, walls);
}

/// Pallets with two known walls or more have a way out on the edges that are not known: they become free.
inline OccupancyGrid with_ways_out(const OccupancyGrid& map, const OccupancyGrid& truth, int least_walls) {
  const Pallets pallets(map, truth);
  OccupancyGrid out = map;
  for (int y = 0; y < pallets.rows; ++y)
    for (int x = 0; x < pallets.columns; ++x) {
      const std::vector<Pallets::Edge> edges = pallets.around_pallet(x, y, 0.5);
      if (std::count(edges.begin(), edges.end(), Pallets::Edge::Wall) < least_walls) continue;
      const TPoint2D a = pallets.node(x, y);
      out = replaced(out, unknown_as_free(out), [&](const TPoint2D& p) {
        return p.x > a.x - 0.3 && p.y > a.y - 0.3 && p.x < a.x + kLattice + 0.3 && p.y < a.y + kLattice + 0.3;
      });
    }
  return out;
}

/// Unknown ground within `reach` [m] of free ground becomes free.
inline OccupancyGrid with_more_floor(const OccupancyGrid& map, double reach) {
  OccupancyGrid out = map;
  const int cells = static_cast<int>(std::lround(reach / map.resolution()));
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      if (map[{x, y}] != Occupancy::Free) continue;
      for (int dy = -cells; dy <= cells; ++dy)
        for (int dx = -cells; dx <= cells; ++dx)
          if (dx * dx + dy * dy <= cells * cells && map.inside({x + dx, y + dy}) &&
              map[{x + dx, y + dy}] == Occupancy::Unknown)
            out[{x + dx, y + dy}] = Occupancy::Free;
    }
  return out;
}

/// What lies beyond the cut of `cut_at` is the mirror image of what lies before it.
inline OccupancyGrid with_its_reflection(const OccupancyGrid& part, const TPoint2D& m, double angle) {
  OccupancyGrid reflected(part.frame());
  const TPoint2D n(std::cos(angle), std::sin(angle));
  for (int y = 0; y < part.height(); ++y)
    for (int x = 0; x < part.width(); ++x) {
      const TPoint2D p = part.centre({x, y});
      const double past = (p.x - m.x) * n.x + (p.y - m.y) * n.y;
      const Cell from = part.cell(p - n * (2.0 * past));
      if (past > 0.0 && part.inside(from)) reflected[{x, y}] = part[from];
    }
  return filled(part, reflected);
}

/// Thin rays of free ground, a cell wide, over unknown ground: from the middle in all directions, `step` [rad] apart.
inline OccupancyGrid with_fans(const OccupancyGrid& map, const TPoint2D& from, double step) {
  OccupancyGrid out = map;
  const double far = map.resolution() * (map.width() + map.height());
  for (double angle = 0.0; angle < 2.0 * kPi; angle += step)
    for (double r = 0.0; r < far; r += 0.5 * map.resolution()) {
      const Cell c = map.cell(from + TPoint2D(std::cos(angle), std::sin(angle)) * r);
      if (!map.inside(c)) break;
      if (out[c] == Occupancy::Unknown) out[c] = Occupancy::Free;
    }
  return out;
}

/// The walls and free ground next to them, all else unknown.
inline OccupancyGrid walls_and_floor_within(const OccupancyGrid& map, double reach) {
  const OccupancyGrid wide = thickened(map, static_cast<int>(std::lround(reach / map.resolution())));
  OccupancyGrid out = map;
  for (std::size_t i = 0; i < out.cells().size(); ++i)
    if (wide.cells()[i] != Occupancy::Occupied) out.cells()[i] = Occupancy::Unknown;
  return out;
}

/// Unknown in every other square of `side` [m], but for walls.
inline OccupancyGrid checkered(const OccupancyGrid& map, double side) {
  OccupancyGrid out = map;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const int column = static_cast<int>(std::floor(map.centre({x, y}).x / side));
      const int row = static_cast<int>(std::floor(map.centre({x, y}).y / side));
      if (map[{x, y}] == Occupancy::Free && (column + row) % 2 == 0) out[{x, y}] = Occupancy::Unknown;
    }
  return out;
}

/// On cells `times` as wide; a cell is wall where any of it is, else what most of it is.
inline OccupancyGrid coarser(const OccupancyGrid& map, int times) {
  GridFrame frame = map.frame();
  frame.resolution *= times;
  frame.width = (map.width() + times - 1) / times;
  frame.height = (map.height() + times - 1) / times;
  OccupancyGrid out(frame);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      int count[3] = {};
      for (int dy = 0; dy < times; ++dy)
        for (int dx = 0; dx < times; ++dx) {
          const Cell c{x * times + dx, y * times + dy};
          if (map.inside(c)) ++count[static_cast<int>(map[c])];
        }
      const bool wall = count[static_cast<int>(Occupancy::Occupied)] > 0;
      const bool free = count[static_cast<int>(Occupancy::Free)] > count[static_cast<int>(Occupancy::Unknown)];
      out[{x, y}] = wall ? Occupancy::Occupied : free ? Occupancy::Free : Occupancy::Unknown;
    }
  return out;
}

/// Gaps of up to `reach` [m] between walls on one line, along either axis, become wall: rooms are closed.
inline OccupancyGrid with_closed_gaps(const OccupancyGrid& map, double reach) {
  OccupancyGrid out = map;
  const int most = static_cast<int>(std::lround(reach / map.resolution()));
  const int least = 4;  // cells of wall in a row that a wall has on both sides of a gap
  const auto sweep = [&](int lines, int length, const auto& cell) {
    for (int line = 0; line < lines; ++line) {
      int run = 0, end = -1;
      for (int i = 0; i < length; ++i) {
        if (map[cell(line, i)] != Occupancy::Occupied) {
          if (run >= least) end = i;
          run = 0;
          continue;
        }
        if (++run == least && end >= 0 && i - least + 1 - end <= most)
          for (int k = end; k <= i - least; ++k) out[cell(line, k)] = Occupancy::Occupied;
      }
    }
  };
  sweep(map.height(), map.width(), [](int line, int i) { return Cell{i, line}; });
  sweep(map.width(), map.height(), [](int line, int i) { return Cell{line, i}; });
  return out;
}

/// Walls that run into unknown ground are drawn on by `reach` [m] there, straight along either axis.
inline OccupancyGrid walls_drawn_on(const OccupancyGrid& map, double reach) {
  const int cells = static_cast<int>(std::lround(reach / map.resolution()));
  constexpr int kRun = 6;  // cells of wall in a row that point somewhere
  OccupancyGrid out = map;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x)
      for (const Cell& way : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
        const auto at = [&](int i) { return Cell{x + i * way.x, y + i * way.y}; };
        const auto is = [&](int i, Occupancy what) { return map.inside(at(i)) && map[at(i)] == what; };
        bool runs = is(1, Occupancy::Unknown);
        for (int i = 0; i < kRun && runs; ++i) runs = is(-i, Occupancy::Occupied);
        for (int i = 1; runs && i <= cells && is(i, Occupancy::Unknown); ++i) out[at(i)] = Occupancy::Occupied;
      }
  return out;
}

/// A wall on every edge of the lattice of which at least `least` of the length is drawn, and none on the others: rooms
/// closed and opened by what the lattice allows.
inline OccupancyGrid snapped_to_lattice(const OccupancyGrid& map, double least) {
  const GridFrame known = known_frame(map, 0.0).value_or(map.frame());
  const double x0 = known.x0 + 0.05, y0 = known.y0 + 0.05;
  const int columns = std::max(1, static_cast<int>(std::lround(known.width * known.resolution / kLattice)));
  const int rows = std::max(1, static_cast<int>(std::lround(known.height * known.resolution / kLattice)));
  OccupancyGrid out = map;
  for (Occupancy& cell : out.cells())
    if (cell == Occupancy::Occupied) cell = Occupancy::Free;
  const auto edge = [&](int ax, int ay, int bx, int by) {
    const TPoint2D a(x0 + ax * kLattice, y0 + ay * kLattice), b(x0 + bx * kLattice, y0 + by * kLattice);
    constexpr int kSamples = 20;
    int drawn = 0;
    for (int i = 1; i < kSamples; ++i) {
      const TPoint2D p = a + (b - a) * (static_cast<double>(i) / kSamples);
      bool wall = false;
      for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx) {
          const Cell c = map.cell({p.x + dx * map.resolution(), p.y + dy * map.resolution()});
          wall = wall || (map.inside(c) && map[c] == Occupancy::Occupied);
        }
      drawn += wall ? 1 : 0;
    }
    if (drawn >= least * (kSamples - 1)) draw_wall(out, a, b, 2);
  };
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x < columns; ++x) edge(x, y, x + 1, y);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x <= columns; ++x) edge(x, y, x, y + 1);
  return out;
}

/// Schemes that leave more than one answer open, or rest on a guess.
inline std::vector<Scheme> more_schemes() {
  using Grid = const OccupancyGrid&;
  using Seed = std::uint64_t;
  const auto angle = [](Seed seed) { return 0.7 * static_cast<double>(seed); };
  const auto part = [=](Grid truth, Seed seed) { return cut_at(truth, angle(seed)); };
  const auto only_part = [=](Grid truth, Seed seed) { return std::vector<OccupancyGrid>{part(truth, seed)}; };
  const auto worn = [](Grid truth, Seed seed) { return with_gaps(with_phantoms(truth, 6, seed), 12, seed); };
  const auto only_worn = [=](Grid truth, Seed seed) { return std::vector<OccupancyGrid>{worn(truth, seed)}; };
  const auto off = [=](Grid truth, Seed seed) { return displaced(worn(truth, seed), 0.07, 0.07, 0.0); };
  const auto only_off = [=](Grid truth, Seed seed) { return std::vector<OccupancyGrid>{off(truth, seed)}; };
  const auto came_apart = [=](Grid truth, Seed seed) {
    const TPoint2D m = middle_of(truth);
    const OccupancyGrid map = worn(truth, seed);
    return replaced(map, displaced(map, 0.9, 0.7, 0.1), [&](const TPoint2D& p) {
      return p.x > m.x + 1.2;
    });  // less than half: the pose of the rest stays the best
  };
  const auto either = [=](Grid truth, Seed seed) {
    return std::vector<OccupancyGrid>{worn(truth, seed), came_apart(truth, seed)};
  };
  const auto cells = [](Grid map, double metres) { return static_cast<int>(std::lround(metres / map.resolution())); };
  return {
      {"part, free beside pallets with two walls", only_part,
       [=](Grid truth, Grid, Seed seed) { return with_ways_out(part(truth, seed), truth, 2); }},
      {"part, free beside pallets with three walls", only_part,
       [=](Grid truth, Grid, Seed seed) { return with_ways_out(part(truth, seed), truth, 3); }},
      {"part, its floor carried on by 0.3 m", only_part,
       [=](Grid truth, Grid, Seed seed) { return with_more_floor(part(truth, seed), 0.3); }},
      {"part, its floor carried on by 0.6 m", only_part,
       [=](Grid truth, Grid, Seed seed) { return with_more_floor(part(truth, seed), 0.6); }},
      {"part, the rest its mirror image", only_part,
       [=](Grid truth, Grid, Seed seed) {
         return with_its_reflection(part(truth, seed), middle_of(truth), angle(seed));
       }},
      {"part, thin fans of free ground over the rest", only_part,
       [=](Grid truth, Grid, Seed seed) { return with_fans(part(truth, seed), middle_of(truth), 0.1); }},
      {"worn: walls and floor within 0.3 m alone", only_worn,
       [=](Grid truth, Grid, Seed seed) { return walls_and_floor_within(worn(truth, seed), 0.3); }},
      {"worn: walls alone", only_worn,
       [=](Grid truth, Grid, Seed seed) { return walls_and_floor_within(worn(truth, seed), 0.0); }},
      {"worn: a checker of unknown, 0.5 m", only_worn,
       [=](Grid truth, Grid, Seed seed) { return checkered(worn(truth, seed), 0.5); }},
      {"worn: a checker of unknown, 0.7 m", only_worn,
       [=](Grid truth, Grid, Seed seed) { return checkered(worn(truth, seed), 0.7); }},
      {"worn: walls twice, 0.12 m apart", only_worn,
       [=](Grid truth, Grid, Seed seed) {
         return blended(worn(truth, seed), displaced(worn(truth, seed), 0.12, 0.12, 0.0));
       }},
      {"worn: walls twice, 0.25 m apart", only_worn,
       [=](Grid truth, Grid, Seed seed) {
         return blended(worn(truth, seed), displaced(worn(truth, seed), 0.25, 0.25, 0.0));
       }},
      {"worn: walls 20 cm thicker", only_worn,
       [=](Grid truth, Grid, Seed seed) { return thickened(worn(truth, seed), cells(truth, 0.1)); }},
      {"worn: walls 40 cm thicker", only_worn,
       [=](Grid truth, Grid, Seed seed) { return thickened(worn(truth, seed), cells(truth, 0.2)); }},
      {"7 cm off: walls 10 cm thicker", only_off,
       [=](Grid truth, Grid, Seed seed) { return thickened(off(truth, seed), cells(truth, 0.05)); }},
      {"7 cm off: walls 20 cm thicker", only_off,
       [=](Grid truth, Grid, Seed seed) { return thickened(off(truth, seed), cells(truth, 0.1)); }},
      {"7 cm off: on cells twice as wide", only_off,
       [=](Grid truth, Grid, Seed seed) { return coarser(off(truth, seed), 2); }},
      {"worn: on cells twice as wide", only_worn,
       [=](Grid truth, Grid, Seed seed) { return coarser(worn(truth, seed), 2); }},
      {"worn: gaps of 0.5 m closed", only_worn,
       [=](Grid truth, Grid, Seed seed) { return with_closed_gaps(worn(truth, seed), 0.5); }},
      {"whole or come apart: both, joined by a strip", either,
       [=](Grid truth, Grid, Seed seed) { return joined_to(worn(truth, seed), came_apart(truth, seed)); }},
      {"whole or bent: both, joined by a strip",
       [=](Grid truth, Seed seed) {
         return std::vector<OccupancyGrid>{worn(truth, seed), bent(worn(truth, seed), 1.6)};
       },
       [=](Grid truth, Grid, Seed seed) { return joined_to(worn(truth, seed), bent(worn(truth, seed), 1.6)); }},
  };
}

/// What a team may conclude from what it saw and from how arenas are built: a wall that runs into unknown ground goes
/// on, walls stand on whole edges of the lattice. More than half of it is right, and no score can tell it from what was
/// seen: such schemes keep no law, they are only measured.
inline std::vector<Scheme> conclusions() {
  using Grid = const OccupancyGrid&;
  using Seed = std::uint64_t;
  const auto part = [](Grid truth, Seed seed) { return cut_at(truth, 0.7 * static_cast<double>(seed)); };
  const auto only_part = [=](Grid truth, Seed seed) { return std::vector<OccupancyGrid>{part(truth, seed)}; };
  const auto worn = [](Grid truth, Seed seed) { return with_gaps(with_phantoms(truth, 6, seed), 12, seed); };
  const auto only_worn = [=](Grid truth, Seed seed) { return std::vector<OccupancyGrid>{worn(truth, seed)}; };
  std::vector<Scheme> out = {
      {"part, walls of which half is seen drawn whole", only_part,
       [=](Grid truth, Grid, Seed seed) { return with_whole_pallets(part(truth, seed), truth, 0.5, false); }},
      {"part, walls of which a third is seen drawn whole", only_part,
       [=](Grid truth, Grid, Seed seed) { return with_whole_pallets(part(truth, seed), truth, 0.3, false); }},
      {"part, its pallets made whole", only_part,
       [=](Grid truth, Grid, Seed seed) { return with_whole_pallets(part(truth, seed), truth, 0.5, true); }},
      {"part, its pallets made whole and their ways out", only_part,
       [=](Grid truth, Grid, Seed seed) {
         return with_ways_out(with_whole_pallets(part(truth, seed), truth, 0.5, true), truth, 2);
       }},
      {"worn: gaps of 1.25 m closed", only_worn,
       [=](Grid truth, Grid, Seed seed) { return with_closed_gaps(worn(truth, seed), 1.25); }},
      {"worn: walls on edges of the lattice drawn to a half", only_worn,
       [=](Grid truth, Grid, Seed seed) { return snapped_to_lattice(worn(truth, seed), 0.5); }},
      {"worn: rooms closed, edges drawn to a fifth are walls", only_worn,
       [=](Grid truth, Grid, Seed seed) { return snapped_to_lattice(worn(truth, seed), 0.2); }},
  };
  for (const double reach : {0.3, 0.6, 1.2})
    out.push_back({"part, walls drawn on by " + std::to_string(reach).substr(0, 3) + " m", only_part,
                   [=](Grid truth, Grid, Seed seed) { return walls_drawn_on(part(truth, seed), reach); }});
  return out;
}

}  // namespace rubble::scoring::testing
