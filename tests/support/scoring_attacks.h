#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "base/rng.h"
#include "scoring/measures/sight_lines.h"
#include "scoring/walls/resample.h"
#include "tests/support/scoring_maze.h"

/// What a team might do to a map to score more than it knows.
namespace rubble::scoring::testing {

constexpr double kLattice = 1.2;  ///< a pallet [m]

/// The western (eastern) half of what is known, cut at the middle.
inline OccupancyGrid half_of(const OccupancyGrid& grid, bool western = true) {
  OccupancyGrid out = grid;
  const GridFrame known = known_frame(grid, 0.0).value_or(grid.frame());
  const double middle = known.x0 + 0.5 * known.width * known.resolution;
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x)
      if ((grid.centre({x, y}).x < middle) != western) out[{x, y}] = Occupancy::Unknown;
  return out;
}

/// Share of the counted lines, by weight, that lie in what `part` knows: a blocked one where its wall is, an open one
/// where walls might be.
inline double share_within(const SightLines& sights, const OccupancyGrid& part) {
  double share = 0.0;
  for (const SightLines::Line& line : sights.lines()) {
    const TPoint2D along = (line.to - line.from) * (1.0 / (line.to - line.from).norm());
    const auto known = [&](double at) { return part[part.cell(line.from + along * at)] != Occupancy::Unknown; };
    if (line.blocked && known(line.middle)) share += line.weight;
    for (const float at : line.doubts)
      if (known(static_cast<double>(at))) share += line.weight / static_cast<double>(line.doubts.size());
  }
  return share;
}

/// An arena out of nothing: the outline and the lattice of `truth`, each inner wall there with probability p.
inline OccupancyGrid guessed(const OccupancyGrid& truth, double p, std::uint64_t seed) {
  const GridFrame known = known_frame(truth, 0.0).value_or(truth.frame());
  OccupancyGrid out(truth.frame());
  const double x0 = known.x0 + 0.5 * truth.resolution();
  const double y0 = known.y0 + 0.5 * truth.resolution();
  const int columns = std::max(1, static_cast<int>(std::lround(known.width * known.resolution / kLattice)));
  const int rows = std::max(1, static_cast<int>(std::lround(known.height * known.resolution / kLattice)));
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const TPoint2D p_cell = out.centre({x, y});
      if (p_cell.x > x0 && p_cell.y > y0 && p_cell.x < x0 + columns * kLattice && p_cell.y < y0 + rows * kLattice)
        out[{x, y}] = Occupancy::Free;
    }
  const auto wall = [&](int ax, int ay, int bx, int by) {
    draw_wall(out, {x0 + ax * kLattice, y0 + ay * kLattice}, {x0 + bx * kLattice, y0 + by * kLattice}, 2);
  };
  wall(0, 0, columns, 0);
  wall(0, rows, columns, rows);
  wall(0, 0, 0, rows);
  wall(columns, 0, columns, rows);
  Rng rng(seed, "guess");
  for (int y = 0; y < rows; ++y)
    for (int x = 1; x < columns; ++x)
      if (rng.uniform() < p) wall(x, y, x, y + 1);
  for (int y = 1; y < rows; ++y)
    for (int x = 0; x < columns; ++x)
      if (rng.uniform() < p) wall(x, y, x + 1, y);
  return out;
}

/// What `map` does not know, taken from `filler`; both on one frame.
inline OccupancyGrid filled(const OccupancyGrid& map, const OccupancyGrid& filler) {
  OccupancyGrid out = map;
  for (std::size_t i = 0; i < out.cells().size(); ++i)
    if (out.cells()[i] == Occupancy::Unknown) out.cells()[i] = filler.cells()[i];
  return out;
}

/// Unknown turned into free space.
inline OccupancyGrid unknown_as_free(const OccupancyGrid& map) {
  return filled(map, OccupancyGrid(map.frame(), Occupancy::Free));
}

/// The share of the walls that are least of a wall (fewest wall cells around them) is turned into free space.
inline OccupancyGrid without_unsure(const OccupancyGrid& map, double share) {
  struct Doubt {
    int around;
    std::size_t at;
  };
  std::vector<Doubt> doubts;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      if (map[{x, y}] != Occupancy::Occupied) continue;
      int around = 0;
      for (int dy = -3; dy <= 3; ++dy)
        for (int dx = -3; dx <= 3; ++dx)
          around += map.inside({x + dx, y + dy}) && map[{x + dx, y + dy}] == Occupancy::Occupied ? 1 : 0;
      doubts.push_back({around, map.frame().index({x, y})});
    }
  std::stable_sort(doubts.begin(), doubts.end(), [](const Doubt& a, const Doubt& b) { return a.around < b.around; });
  OccupancyGrid out = map;
  for (std::size_t i = 0; i < static_cast<std::size_t>(share * static_cast<double>(doubts.size())); ++i)
    out.cells()[doubts[i].at] = Occupancy::Free;
  return out;
}

/// The drawing stretched on the same lattice.
inline OccupancyGrid stretched(const OccupancyGrid& map, double factor) {
  GridFrame frame = map.frame();
  frame.width = static_cast<int>(std::lround(map.width() * factor));
  frame.height = static_cast<int>(std::lround(map.height() * factor));
  OccupancyGrid out(frame);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x)
      out[{x, y}] = map[{std::min(map.width() - 1, static_cast<int>(x / factor)),
                         std::min(map.height() - 1, static_cast<int>(y / factor))}];
  return out;
}

/// `map` and copies of it `factors` times as large, side by side on one canvas.
inline OccupancyGrid beside_copies(const OccupancyGrid& map, const std::vector<double>& factors) {
  constexpr int kBetween = 10;  // [cells]
  std::vector<OccupancyGrid> drawings = {map};
  for (const double factor : factors) drawings.push_back(stretched(map, factor));
  GridFrame frame = map.frame();
  frame.width = 0;
  for (const OccupancyGrid& drawing : drawings) {
    frame.width += drawing.width() + kBetween;
    frame.height = std::max(frame.height, drawing.height());
  }
  OccupancyGrid out(frame);
  int west = 0;
  for (const OccupancyGrid& drawing : drawings) {
    for (int y = 0; y < drawing.height(); ++y)
      std::copy(drawing.row(y), drawing.row(y) + drawing.width(), out.row(y) + west);
    west += drawing.width() + kBetween;
  }
  return out;
}

/// A wall all around, `cells` away from the map's edge.
inline OccupancyGrid framed(const OccupancyGrid& map, int cells) {
  OccupancyGrid out = padded(map, cells + 4);
  for (int y = 2; y < out.height() - 2; ++y)
    for (int x = 2; x < out.width() - 2; ++x)
      if (x < 4 || y < 4 || x >= out.width() - 4 || y >= out.height() - 4) out[{x, y}] = Occupancy::Occupied;
  return out;
}

/// Each cell takes the class that is most frequent within one cell of it, twice.
inline OccupancyGrid smoothed(const OccupancyGrid& map) {
  OccupancyGrid out = map;
  for (int pass = 0; pass < 2; ++pass) {
    const OccupancyGrid from = out;
    for (int y = 1; y + 1 < map.height(); ++y)
      for (int x = 1; x + 1 < map.width(); ++x) {
        int count[3] = {};
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) ++count[static_cast<int>(from[{x + dx, y + dy}])];
        const int most = static_cast<int>(std::max_element(count, count + 3) - count);
        if (count[most] > count[static_cast<int>(from[{x, y}])]) out[{x, y}] = static_cast<Occupancy>(most);
      }
  }
  return out;
}

}  // namespace rubble::scoring::testing
