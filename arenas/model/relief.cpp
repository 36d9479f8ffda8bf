#include "arenas/model/relief.h"

#include <array>

#include "arenas/model/arena.h"

namespace rubble::arenas {
namespace {

constexpr std::array<char, 4> kRising{'>', '^', '<', 'v'};  ///< the ramp that rises to kCellSides[i]

Cell operator+(Cell a, Cell b) { return {a.x + b.x, a.y + b.y}; }
Cell operator*(int k, Cell c) { return {k * c.x, k * c.y}; }

/// Height of a corner in ramp rises; x and y: 0 west or south, 1 east or north.
int corner(const Tile& tile, int x, int y) {
  switch (tile.shape) {
    case '>':
      return tile.level + x;
    case '<':
      return tile.level + 1 - x;
    case '^':
      return tile.level + y;
    case 'v':
      return tile.level + 1 - y;
    default:
      return tile.level;
  }
}

/// A rectangle of pallets that is proposed as a whole.
struct Stamp {
  Cell corner;       ///< where it begins
  int direction;     ///< of the first row's slope, index into kCellSides
  int along;         ///< pallets along the slope
  int across;        ///< pallets side by side
  bool has_plateau;  ///< ramp up, flat on top, ramp down; otherwise up and down in turn
  int height = 1;    ///< of the plateau, in ramps; 2: ramp up, ramp up, flat on top, and down again if it goes on
};

Tile tile_of(const Stamp& stamp, int i) {
  const std::size_t up = static_cast<std::size_t>(stamp.direction);
  if (stamp.height > 1) {
    if (i == stamp.height) return {'.', stamp.height};
    return i < stamp.height ? Tile{kRising[up], i} : Tile{kRising[(up + 2) % 4], 2 * stamp.height - i};
  }
  if (stamp.has_plateau && i > 0 && i + 1 < stamp.along) return {'.', 1};
  const bool rises = stamp.has_plateau ? i == 0 : i % 2 == 0;
  return {kRising[rises ? up : (up + 2) % 4], 0};
}

Stamp draw_stamp(int columns, int rows, Rng& rng) {
  const int x = static_cast<int>(rng.below(static_cast<std::uint32_t>(columns)));
  const int y = static_cast<int>(rng.below(static_cast<std::uint32_t>(rows)));
  const int direction = static_cast<int>(rng.below(4));
  const int along = 1 + static_cast<int>(rng.below(3));
  const int across = 1 + static_cast<int>(rng.below(3));
  const bool has_plateau = along == 3 && rng.uniform() < 0.5;
  return {{x, y}, direction, along, across, has_plateau};
}

/// Two ramps in line up to a floor of 0.42 m (at 10 deg), and every second time down again behind it.
Stamp draw_tower(int columns, int rows, Rng& rng) {
  const int x = static_cast<int>(rng.below(static_cast<std::uint32_t>(columns)));
  const int y = static_cast<int>(rng.below(static_cast<std::uint32_t>(rows)));
  const int direction = static_cast<int>(rng.below(4));
  const int along = rng.uniform() < 0.5 ? 3 : 5;
  return {{x, y}, direction, along, 1, true, 2};
}

/// Lays the stamp; false: it does not fit, or would cover the start.
bool lay(const Stamp& stamp, Cell start, Relief& relief) {
  const Cell along = kCellSides[static_cast<std::size_t>(stamp.direction)];
  const Cell across{along.y, along.x};
  for (int i = 0; i < stamp.along; ++i) {
    for (int k = 0; k < stamp.across; ++k) {
      const Cell cell = stamp.corner + i * along + k * across;
      if (!relief.inside(cell) || cell == start) return false;
      relief[cell] = tile_of(stamp, i);
    }
  }
  return true;
}

int count_ramps(const Relief& relief) {
  int ramps = 0;
  for (const Tile& tile : relief.cells()) ramps += tile.is_ramp() ? 1 : 0;
  return ramps;
}

}  // namespace

mrpt::math::TPoint2D centre_of(Cell cell) { return {kPallet * (cell.x + 0.5), kPallet * (cell.y + 0.5)}; }

bool is_smooth(const Relief& relief, Cell a, Cell b) {
  const Tile& p = relief[a];
  const Tile& q = relief[b];
  if (b.x != a.x) {
    const int east = b.x > a.x ? 1 : 0;
    return corner(p, east, 0) == corner(q, 1 - east, 0) && corner(p, east, 1) == corner(q, 1 - east, 1);
  }
  const int north = b.y > a.y ? 1 : 0;
  return corner(p, 0, north) == corner(q, 0, 1 - north) && corner(p, 1, north) == corner(q, 1, 1 - north);
}

std::vector<Cell> smooth_neighbours(const Relief& relief, Cell cell) {
  std::vector<Cell> found;
  for (const Cell step : kCellSides) {
    const Cell next = cell + step;
    if (relief.inside(next) && is_smooth(relief, cell, next)) found.push_back(next);
  }
  return found;
}

bool is_connected(const Relief& relief) {
  Grid<std::uint8_t> seen(relief.frame());
  std::vector<Cell> open{{0, 0}};
  seen[{0, 0}] = 1;
  std::size_t reached = 0;
  while (!open.empty()) {
    const Cell cell = open.back();
    open.pop_back();
    ++reached;
    for (const Cell step : kCellSides) {
      const Cell next = cell + step;
      if (!relief.inside(next) || seen[next] != 0 || !is_smooth(relief, cell, next)) continue;
      seen[next] = 1;
      open.push_back(next);
    }
  }
  return reached == relief.frame().size();
}

Relief grow_relief(int columns, int rows, int ramps, Cell start, int tallest, Rng& rng) {
  constexpr int kPatience = 1500;  // proposals refused in a row
  Relief relief(GridFrame{columns, rows, 1.0, 0.0, 0.0});
  int laid = 0;
  for (int refused = 0; laid < ramps && refused < kPatience; ++refused) {
    Relief proposal = relief;
    const bool is_tower = tallest > 1 && rng.uniform() < 0.5;
    const Stamp stamp = is_tower ? draw_tower(columns, rows, rng) : draw_stamp(columns, rows, rng);
    if (!lay(stamp, start, proposal)) continue;
    const int count = count_ramps(proposal);
    if (count <= laid || count > ramps || !is_connected(proposal)) continue;
    relief = proposal;
    laid = count;
    refused = 0;
  }
  return relief;
}

}  // namespace rubble::arenas
