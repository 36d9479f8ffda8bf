#include "arenas/generate/furnish.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/angle.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

constexpr double kBoxBack = 0.5 * (kPallet - 0.02 - 0.4);  ///< middle of a pallet to middle of a box at its wall [m]

double to_millimetres(double value) { return static_cast<double>(std::llround(value * 1000.0)) / 1000.0; }

template <class T>
void shuffle(std::vector<T>& items, Rng& rng) {
  for (std::size_t i = items.size(); i > 1; --i) {
    const std::size_t k = rng.below(static_cast<std::uint32_t>(i));
    std::swap(items[i - 1], items[k]);
  }
}

/// Sides of a pallet that have a wall, as quarter turns from east.
std::array<bool, 4> walls_of(const Maze& maze, Cell cell) {
  std::array<bool, 4> walls{};
  for (std::size_t i = 0; i < 4; ++i)
    walls[i] = !is_open(maze, cell, {cell.x + kCellSides[i].x, cell.y + kCellSides[i].y});
  return walls;
}

/// Lower is better: dead ends, then corners, corridors, T-junctions, crossings; any flat pallet before any ramp.
int rank(const Relief& relief, const Maze& maze, Cell cell) {
  const std::array<bool, 4> walls = walls_of(maze, cell);
  const auto count = std::count(walls.begin(), walls.end(), true);
  const bool is_corner = count == 2 && walls[0] != walls[2];
  const int kind = count >= 3 ? 0 : is_corner ? 1 : 4 - static_cast<int>(count);
  return kind + (relief[cell].is_ramp() ? 10 : 0);
}

/// The wall the box leans on: in a dead end the one opposite the way in.
std::size_t back_wall(const std::array<bool, 4>& walls, Rng& rng) {
  std::vector<std::size_t> candidates;
  std::vector<std::size_t> best;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!walls[i]) continue;
    candidates.push_back(i);
    if (!walls[(i + 2) % 4]) best.push_back(i);
  }
  if (!best.empty()) candidates = best;
  if (candidates.empty()) candidates = {0, 1, 2, 3};  // a crossing: the box stands free at the pallet's corner
  return candidates[rng.below(static_cast<std::uint32_t>(candidates.size()))];
}

PlacedVictim place_victim(const Maze& maze, Cell cell, Rng& rng) {
  const std::array<bool, 4> walls = walls_of(maze, cell);
  const std::size_t back = back_wall(walls, rng);
  PlacedVictim victim;
  victim.cell = cell;
  victim.facing = static_cast<int>((back + 2) % 4);
  victim.position = centre_of(cell) + TPoint2D{kBoxBack * kCellSides[back].x, kBoxBack * kCellSides[back].y};
  // Where the way leads past the box, it moves into the corner, so that 0.8 m stay free in both directions.
  const auto count = std::count(walls.begin(), walls.end(), true);
  const std::size_t left = (back + 1) % 4;
  const std::size_t right = (back + 3) % 4;
  if (count == 0 || walls[left] != walls[right]) {
    const Cell aside = kCellSides[walls[right] ? right : left];
    victim.position = victim.position + TPoint2D{kBoxBack * aside.x, kBoxBack * aside.y};
  }
  const double heat = rng.uniform();
  const double sound = rng.uniform();
  const double co2 = rng.uniform();
  victim.heat = heat < 0.8;
  victim.sound = sound < 0.4;
  victim.co2 = co2 < 0.5;
  return victim;
}

/// An irregular convex scrap: corners on an ellipse. `size` is its longer axis [m].
Outline scrap(const TPoint2D& centre, double size, Rng& rng) {
  const int corners = 4 + static_cast<int>(rng.below(4));
  const double turn = rng.uniform(0.0, 2.0 * kPi);
  const double flatness = rng.uniform(0.6, 1.0);
  Outline outline;
  for (int i = 0; i < corners; ++i) {
    const double bearing = 2.0 * kPi * (i + rng.uniform(0.0, 0.6)) / corners;
    const double along = 0.5 * size * std::cos(bearing);
    const double across = 0.5 * size * flatness * std::sin(bearing);
    outline.push_back({to_millimetres(centre.x + std::cos(turn) * along - std::sin(turn) * across),
                       to_millimetres(centre.y + std::sin(turn) * along + std::cos(turn) * across)});
  }
  return outline;
}

/// A place in the pallet at least `margin` from its edges.
TPoint2D place_in(Cell cell, double margin, Rng& rng) {
  const double reach = 0.5 * kPallet - margin;
  const double x = rng.uniform(-reach, reach);
  const double y = rng.uniform(-reach, reach);
  const TPoint2D centre = centre_of(cell);
  return {to_millimetres(centre.x + x), to_millimetres(centre.y + y)};
}

/// Mostly balls that stay below the lidar's plane (0.35 m); one in twenty is a heap that can reach it.
double ball_radius(Rng& rng) {
  const bool is_heap = rng.uniform() < 0.05;
  const double u = rng.uniform();
  return to_millimetres(is_heap ? 0.16 + 0.065 * u : 0.05 + 0.10 * u);
}

void scatter_balls(Cell cell, Rng& rng, Furniture& furniture) {
  const std::size_t first = furniture.balls.size();
  const int count = 1 + static_cast<int>(rng.below(3));
  for (int i = 0; i < count; ++i) {
    const double radius = ball_radius(rng);
    const TPoint2D p = place_in(cell, radius + 0.03, rng);
    const bool is_clear =
        std::all_of(furniture.balls.begin() + static_cast<std::ptrdiff_t>(first), furniture.balls.end(),
                    [&](const PaperBall& other) {
                      return std::hypot(p.x - other.position.x, p.y - other.position.y) > radius + other.radius + 0.01;
                    });
    if (is_clear) furniture.balls.push_back({p, radius, 0.0});
  }
}

std::vector<Cell> all_but(const Relief& relief, const std::vector<Cell>& taken) {
  std::vector<Cell> cells;
  for (int y = 0; y < relief.height(); ++y) {
    for (int x = 0; x < relief.width(); ++x) {
      const Cell cell{x, y};
      if (std::find(taken.begin(), taken.end(), cell) == taken.end()) cells.push_back(cell);
    }
  }
  return cells;
}

}  // namespace

std::vector<PlacedVictim> place_victims(const Relief& relief, const Maze& maze, const std::vector<Cell>& taken,
                                        int count, Rng& rng) {
  std::vector<Cell> cells = all_but(relief, taken);
  shuffle(cells, rng);
  std::stable_sort(cells.begin(), cells.end(),
                   [&](Cell a, Cell b) { return rank(relief, maze, a) < rank(relief, maze, b); });
  cells.resize(std::min(cells.size(), static_cast<std::size_t>(count)));
  std::vector<PlacedVictim> victims;
  for (const Cell cell : cells) victims.push_back(place_victim(maze, cell, rng));
  return victims;
}

void hide_victims(int sound, int co2, Rng& rng, std::vector<PlacedVictim>& victims) {
  std::vector<PlacedVictim*> order;
  for (PlacedVictim& victim : victims) order.push_back(&victim);
  shuffle(order, rng);
  for (std::size_t i = 0; i < order.size() && i < static_cast<std::size_t>(sound + co2); ++i) {
    PlacedVictim& victim = *order[i];
    victim.appearance = victim.heat = false;
    victim.sound = i < static_cast<std::size_t>(sound);
    victim.co2 = !victim.sound;
  }
}

void scatter_paper(const Relief& relief, std::vector<Cell> taken, int count, Rng& rng, Furniture& furniture) {
  for (const PlacedVictim& victim : furniture.victims) taken.push_back(victim.cell);
  std::vector<Cell> cells = all_but(relief, taken);
  shuffle(cells, rng);
  cells.resize(std::min(cells.size(), static_cast<std::size_t>(count)));
  for (const Cell cell : cells) {
    const int sheets = 1 + static_cast<int>(rng.below(4));
    for (int i = 0; i < sheets; ++i) {
      const double size = rng.uniform(0.2, 0.5);
      const TPoint2D p = place_in(cell, 0.5 * size + 0.02, rng);
      furniture.sheets.push_back(scrap(p, size, rng));
    }
    if (rng.uniform() < 0.5) scatter_balls(cell, rng, furniture);
  }
}

}  // namespace rubble::arenas
