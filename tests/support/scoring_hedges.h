#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/scoring_attacks.h"
#include "tests/support/scoring_grounds.h"
#include "tests/support/scoring_schemes.h"

/// Schemes of a team that draws less, more or coarser than it knows, and hopes for the doubt. Written when version 8 of
/// the score stood.
namespace rubble::scoring::testing {

/// Free lines of one cell, `apart` [m] from each other, over the outline of `truth`; the rest is unknown.
inline OccupancyGrid free_lines(const OccupancyGrid& truth, double apart) {
  OccupancyGrid out = hall_like(truth, false);
  const int period = static_cast<int>(std::lround(apart / truth.resolution()));
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      if ((x + y) % period != 0) out[{x, y}] = Occupancy::Unknown;
  return out;
}

/// Cells so many times as wide: wall where any of them is (`cautious`), or where at least half of them are.
inline OccupancyGrid in_wide_cells(const OccupancyGrid& map, int times, bool cautious) {
  GridFrame frame = map.frame();
  frame.resolution *= times;
  frame.width = (frame.width + times - 1) / times;
  frame.height = (frame.height + times - 1) / times;
  OccupancyGrid out(frame);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      int count[3] = {};
      for (int v = 0; v < times; ++v)
        for (int u = 0; u < times; ++u) {
          const Cell c{x * times + u, y * times + v};
          if (map.inside(c)) ++count[static_cast<int>(map[c])];
        }
      const int walls = count[static_cast<int>(Occupancy::Occupied)];
      if (walls > 0 && (cautious || 2 * walls >= times * times))
        out[{x, y}] = Occupancy::Occupied;
      else if (count[static_cast<int>(Occupancy::Free)] > 0)
        out[{x, y}] = Occupancy::Free;
    }
  return out;
}

/// Walls that are less than `least` [m] long along either axis are taken away, and all that is unknown within the
/// outline is free.
inline OccupancyGrid only_long_walls(const OccupancyGrid& map, double least) {
  const int cells = static_cast<int>(std::lround(least / map.resolution()));
  OccupancyGrid out = filled(map, hall_like(map, false));
  for (Occupancy& cell : out.cells())
    if (cell == Occupancy::Occupied) cell = Occupancy::Free;
  const auto keep_runs = [&](bool along_x) {
    const int lines = along_x ? map.height() : map.width();
    const int length = along_x ? map.width() : map.height();
    for (int line = 0; line < lines; ++line)
      for (int at = 0, run = 0; at <= length; ++at) {
        const auto cell = [&](int i) { return along_x ? Cell{i, line} : Cell{line, i}; };
        if (at < length && map[cell(at)] == Occupancy::Occupied) {
          ++run;
          continue;
        }
        for (int i = at - run; run >= cells && i < at; ++i) out[cell(i)] = Occupancy::Occupied;
        run = 0;
      }
  };
  keep_runs(true);
  keep_runs(false);
  return out;
}

/// Squares of wall, `side` [m] wide, where lines of the lattice cross.
inline OccupancyGrid posts_on_lattice(const OccupancyGrid& truth, double side) {
  const GridFrame known = known_frame(truth, 0.0).value_or(truth.frame());
  OccupancyGrid out = hall_like(truth, false);
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const TPoint2D p = out.centre({x, y});
      const double off_x = std::abs(std::remainder(p.x - known.x0 - 0.05, kLattice));
      const double off_y = std::abs(std::remainder(p.y - known.y0 - 0.05, kLattice));
      if (out[{x, y}] == Occupancy::Free && std::max(off_x, off_y) <= 0.5 * side) out[{x, y}] = Occupancy::Occupied;
    }
  return out;
}

/// Coarse cells, thin free lines, posts.
inline std::vector<Scheme> hedges() {
  using Grid = const OccupancyGrid&;
  using Seed = std::uint64_t;
  const auto part = [](Grid truth, Seed seed) { return cut_at(truth, 0.7 * static_cast<double>(seed)); };
  const auto only_part = [=](Grid truth, Seed seed) { return std::vector<OccupancyGrid>{part(truth, seed)}; };
  const auto nothing = [](Grid truth, Seed) { return std::vector<OccupancyGrid>{OccupancyGrid(truth.frame())}; };
  const auto off = [](Grid truth, Seed seed) {  // a map whose parts lie up to some centimetres off
    return displaced(bent(truth, 0.25), 0.03 * std::cos(static_cast<double>(seed)), 0.03, 0.004);
  };
  const auto only_off = [=](Grid truth, Seed seed) { return std::vector<OccupancyGrid>{off(truth, seed)}; };
  std::vector<Scheme> out;
  for (const int times : {2, 3, 4})
    for (const bool cautious : {true, false})
      out.push_back({"bent: cells of " + std::to_string(5 * times) + " cm, " + (cautious ? "any wall" : "half walls"),
                     only_off,
                     [=](Grid truth, Grid, Seed seed) { return in_wide_cells(off(truth, seed), times, cautious); }});
  const std::vector<Scheme> rest = {
      {"bent: walls 10 cm thicker", only_off,
       [=](Grid truth, Grid, Seed seed) { return thickened(off(truth, seed), 1); }},
      {"part, thin free lines 0.4 m apart", only_part,
       [=](Grid truth, Grid, Seed seed) { return filled(part(truth, seed), free_lines(truth, 0.4)); }},
      {"part, thin free lines 0.8 m apart", only_part,
       [=](Grid truth, Grid, Seed seed) { return filled(part(truth, seed), free_lines(truth, 0.8)); }},
      {"part: long walls alone, all else free", only_part,
       [=](Grid truth, Grid, Seed seed) { return only_long_walls(part(truth, seed), 1.1); }},
      {"part, the rest posts of 0.4 m on the lattice", only_part,
       [=](Grid truth, Grid, Seed seed) { return filled(part(truth, seed), posts_on_lattice(truth, 0.4)); }},
      {"nothing: posts of 0.4 m on the lattice", nothing,
       [](Grid truth, Grid, Seed) { return posts_on_lattice(truth, 0.4); }},
      {"nothing: posts of 0.8 m on the lattice", nothing,
       [](Grid truth, Grid, Seed) { return posts_on_lattice(truth, 0.8); }},
  };
  out.insert(out.end(), rest.begin(), rest.end());
  return out;
}

/// Both of two hypotheses a few centimetres apart. One alone, right or not, is the honest map; in "to either side" each
/// is wrong by half of it. These gain: see docs/scoring_measured.md.
inline std::vector<Scheme> near_copies() {
  using Grid = const OccupancyGrid&;
  using Seed = std::uint64_t;
  const auto either = [](double by) {
    return [by](Grid truth, Seed) {
      return std::vector<OccupancyGrid>{truth, displaced(truth, 0.8 * by, 0.6 * by, 0.0)};
    };
  };
  const auto both = [](double by) {
    return [by](Grid truth, Grid, Seed) { return blended(truth, displaced(truth, 0.8 * by, 0.6 * by, 0.0)); };
  };
  std::vector<Scheme> out;
  for (const double by : {0.06, 0.1, 0.15, 0.25})
    out.push_back({"off by " + std::to_string(by).substr(0, 4) + " m or not: both drawn", either(by), both(by)});
  for (const double by : {0.1, 0.2}) {
    const auto east = [by](Grid truth) { return displaced(truth, 0.5 * by, 0.5 * by, 0.0); };
    const auto west = [by](Grid truth) { return displaced(truth, -0.5 * by, -0.5 * by, 0.0); };
    out.push_back({"off by " + std::to_string(0.5 * by).substr(0, 4) + " m to either side: both drawn",
                   [=](Grid truth, Seed) {
                     return std::vector<OccupancyGrid>{east(truth), west(truth)};
                   },
                   [=](Grid truth, Grid, Seed) { return blended(east(truth), west(truth)); }});
  }
  return out;
}

}  // namespace rubble::scoring::testing
