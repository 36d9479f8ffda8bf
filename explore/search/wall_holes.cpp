#include "explore/search/wall_holes.h"

#include <algorithm>
#include <cmath>

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;

constexpr double kBoardEnd = 0.20;    ///< wall on both sides of a hole, which boards have at their ends [m]
constexpr double kSameBoard = 0.75;   ///< from one hole of a board of 1.2 m to where the next one ends [m]
constexpr double kBesideWall = 0.15;  ///< what is not farther from a wall lies at it [m]

/// Whether a cell, or the one to either side of its row along a wall, has something of it: walls lie slightly askew.
template <typename Is>
bool across_row(const Traversable& floor, Cell c, Cell along, Is is) {
  for (int off = -1; off <= 1; ++off) {
    const Cell beside{c.x + off * along.y, c.y + off * along.x};
    if (floor.cells.inside(beside) && is(beside)) return true;
  }
  return false;
}

}  // namespace

std::vector<WallHole> wall_holes(const Traversable& floor) {
  const double resolution = floor.frame().resolution;
  const int most = static_cast<int>(std::lround(kWidestHole / resolution));
  const int straight = static_cast<int>(std::lround(kBoardEnd / resolution));
  const auto wall = [&](Cell c) { return floor.cells[c] == Occupancy::Occupied; };
  const auto sure = [&](Cell c) { return wall(c) && floor.unsure[c] == 0; };
  std::vector<WallHole> holes;
  for (int y = 0; y < floor.cells.height(); ++y)
    for (int x = 0; x < floor.cells.width(); ++x) {
      if (!sure({x, y})) continue;
      for (const Cell along : {Cell{1, 0}, Cell{0, 1}}) {
        const auto at = [&](int i) { return Cell{x + i * along.x, y + i * along.y}; };
        int wide = 0;
        while (wide <= most && floor.cells.inside(at(wide + 1)) && !across_row(floor, at(wide + 1), along, sure))
          ++wide;
        if (wide == 0 || wide > most || !floor.cells.inside(at(wide + 1))) continue;
        bool board = true;
        for (int i = 1; i < straight && board; ++i)
          board = across_row(floor, at(-i), along, wall) && across_row(floor, at(wide + 1 + i), along, wall);
        if (!board) continue;
        const TPoint2D first = floor.cells.centre(at(1)), last = floor.cells.centre(at(wide));
        holes.push_back({(first + last) * 0.5, along});
      }
    }
  return holes;
}

bool beside_hole(const std::vector<WallHole>& holes, const TPoint2D& place, Cell along) {
  return std::any_of(holes.begin(), holes.end(), [&](const WallHole& hole) {
    if (hole.along != along) return false;
    const TPoint2D off = place - hole.p_map;
    return std::abs(off.x * along.x + off.y * along.y) <= kSameBoard &&
           std::abs(off.x * along.y + off.y * along.x) <= kBesideWall;
  });
}

}  // namespace rubble::explore
