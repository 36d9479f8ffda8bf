#pragma once

#include <mrpt/math/TPoint2D.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "base/grid.h"
#include "scoring/measures/wall_pieces.h"

namespace rubble::scoring {

constexpr double kNarrowUnknown =
    0.55;  ///< unknown ground between known ground hides nothing: a halo around a wall [m]

/// A map prepared to be looked across at many poses. The map must outlive it.
struct SightMap {
  explicit SightMap(const OccupancyGrid& source, Ragged ragged = Ragged::AreWalls)
      : grid(source), pieces(wall_pieces(source, ragged)) {}
  const OccupancyGrid& grid;
  WallPieces pieces;
};

/// One wall on a line, [m] from its start.
struct Crossing {
  double from = 0.0;
  double to = 0.0;
  double strength = 0.0;
  double middle() const { return 0.5 * (from + to); }
  double thickness() const { return to - from; }
};

struct Stretch {
  double from = 0.0;
  double to = 0.0;
};

/// What a map shows on a line, [m] from its start.
struct Sight {
  std::vector<Crossing> walls;
  std::vector<Stretch> unseen;
  double unknown = 0.0;  ///< all of it [m]

  void leave_unseen(double from, double to) {
    const bool goes_on = !unseen.empty() && unseen.back().to >= from;
    if (!goes_on) unseen.push_back({from, to});
    unseen.back().to = to;
  }
  /// Short unknown stretches between known ground are open ground: whoever knows both sides of a wall knows the wall.
  void close_holes(double length) {
    const auto is_hole = [&](const Stretch& s) {
      return s.from > 0.0 && s.to < length && s.to - s.from <= kNarrowUnknown;
    };
    unseen.erase(std::remove_if(unseen.begin(), unseen.end(), is_hole), unseen.end());
  }
  bool sees(double at) const {
    return std::none_of(unseen.begin(), unseen.end(), [at](const Stretch& s) { return at >= s.from && at <= s.to; });
  }
};

/// Stretches of a line, [m] from its start, where walls of the map are not judged.
using Unjudged = std::vector<std::pair<float, float>>;

/// Looks across a map that is kept elsewhere.
struct SightGround {
  explicit SightGround(const SightMap& map) : grid(map.grid), pieces(map.pieces) {}
  bool is(const mrpt::math::TPoint2D& p, Occupancy what) const {
    const Cell c = grid.cell(p);
    return grid.inside(c) && grid[c] == what;
  }
  bool known(const mrpt::math::TPoint2D& p) const {
    const Cell c = grid.cell(p);
    return grid.inside(c) && grid[c] != Occupancy::Unknown;
  }
  /// Walks from a to b, which lie in this map and are `length` apart in the truth. Walls within `unjudged` are passed
  /// by.
  void look(const mrpt::math::TPoint2D& a, const mrpt::math::TPoint2D& b, double length, Sight& out,
            const Unjudged& unjudged = {}) const;

  const OccupancyGrid& grid;
  const WallPieces& pieces;
};

}  // namespace rubble::scoring
