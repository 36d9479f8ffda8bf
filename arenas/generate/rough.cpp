#include "arenas/generate/rough.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rubble::arenas {
namespace {

/// What lies where while obstacles are being laid.
class Site {
 public:
  Site(const Relief& relief, Cell start, Maze& maze)
      : relief_(relief), maze_(maze), start_(start), barred_(relief.frame()), used_(relief.frame()) {
    used_[start] = 1;
  }

  /// Flat ground without anything on it.
  bool is_plain(Cell c) const { return is_level(c) && used_[c] == 0; }
  /// Whether all pallets that are not barred reach each other over those with `more` barred, too.
  bool stays_connected(const std::vector<Cell>& more) const {
    Grid<std::uint8_t> seen = barred_;
    for (const Cell c : more) seen[c] = 1;
    std::size_t left = static_cast<std::size_t>(std::count(seen.cells().begin(), seen.cells().end(), 0));
    std::vector<Cell> open{start_};
    seen[start_] = 1;
    for (--left; !open.empty();) {
      const Cell cell = open.back();
      open.pop_back();
      for (const Cell next : open_neighbours(maze_, cell)) {
        if (seen[next] != 0) continue;
        seen[next] = 1;
        --left;
        open.push_back(next);
      }
    }
    return left == 0;
  }
  /// Flat ground, whatever lies on it.
  bool is_level(Cell c) const { return relief_.inside(c) && !relief_[c].is_ramp() && relief_[c].level == 0; }

  void take(Cell c, bool bars) {
    used_[c] = 1;
    barred_[c] = bars ? 1 : 0;
  }
  Maze& maze() { return maze_; }
  bool is_barred(Cell c) const { return barred_[c] != 0; }

 private:
  const Relief& relief_;
  Maze& maze_;
  Cell start_;
  Grid<std::uint8_t> barred_;
  Grid<std::uint8_t> used_;
};

/// Quarter turns clockwise from north of the way from a to its neighbour b.
int turn_of(Cell a, Cell b) {
  if (b.y != a.y) return b.y > a.y ? 0 : 2;
  return b.x > a.x ? 1 : 3;
}

/// A field in one pallet.
bool lay_field(const std::string& type, Cell cell, int turn, Site& site, std::vector<RoughPallet>& laid) {
  if (!site.is_plain(cell) || !site.stays_connected({cell})) return false;
  site.take(cell, true);
  laid.push_back({cell, type, turn, 0.0, true});
  return true;
}

/// A foot and a top in line behind `before`, walled in on all other sides.
bool lay_tower(int which, Cell top, int direction, Site& site, std::vector<RoughPallet>& laid) {
  const Cell up = clockwise_side(static_cast<std::size_t>(direction));
  const Cell foot{top.x - up.x, top.y - up.y};
  const Cell before{foot.x - up.x, foot.y - up.y};
  if (!site.is_plain(top) || !site.is_plain(foot) || !site.is_level(before) || site.is_barred(before)) return false;
  if (!site.stays_connected({top, foot})) return false;
  for (const Cell cell : {top, foot}) {
    for (const Cell next : open_neighbours(site.maze(), cell)) {
      if (site.is_barred(next)) return false;  // an obstacle beyond would lose its way in
    }
  }
  for (const Cell cell : {top, foot}) {
    for (const Cell next : open_neighbours(site.maze(), cell)) set_open(site.maze(), cell, next, false);
  }
  set_open(site.maze(), before, foot, true);
  set_open(site.maze(), foot, top, true);
  site.take(top, true);
  site.take(foot, true);
  static const std::array<const char*, 3> kWaysUp{"stairs_120_solid", "steep_ramp_45", "steep_ramp_35"};
  const bool is_low = which == 2;
  const double height = is_low ? kRise35 : kPallet;
  const int turn = turn_of(foot, top);
  laid.push_back({foot, kWaysUp[static_cast<std::size_t>(which)], turn, 0.0, true});
  laid.push_back({top, is_low ? "elevated_floor_084" : "elevated_floor_120_solid", turn, height, true});
  return true;
}

/// A corridor's pallet gets a ceiling.
bool lay_tunnel(Cell cell, Site& site, std::vector<RoughPallet>& laid) {
  const std::vector<Cell> ways = open_neighbours(site.maze(), cell);
  if (!site.is_plain(cell) || ways.size() != 2) return false;
  if (ways[0].x + ways[1].x != 2 * cell.x || ways[0].y + ways[1].y != 2 * cell.y) return false;
  site.take(cell, false);
  laid.push_back({cell, "tunnel", turn_of(cell, ways[0]), 0.0, false});
  return true;
}

}  // namespace

std::vector<RoughPallet> lay_rough(ArenaKind kind, const Relief& relief, Cell start, double share, Maze& maze,
                                   Rng& rng) {
  std::vector<RoughPallet> laid;
  if (kind == ArenaKind::Yellow) return laid;
  Site site(relief, start, maze);
  const auto wanted = static_cast<std::size_t>(std::llround(share * static_cast<double>(relief.frame().size())));
  // Towers need the most room, so they come first: a third of the red obstacles.
  for (int proposal = 0; kind == ArenaKind::Red && proposal < 400 && 3 * (laid.size() + 2) <= wanted + 3; ++proposal) {
    const int x = static_cast<int>(rng.below(static_cast<std::uint32_t>(relief.width())));
    const int y = static_cast<int>(rng.below(static_cast<std::uint32_t>(relief.height())));
    const int turn = static_cast<int>(rng.below(4));
    const int which = static_cast<int>(rng.below(3));
    lay_tower(which, {x, y}, turn, site, laid);
  }
  constexpr int kPatience = 1500;  // proposals refused in a row
  for (int refused = 0; laid.size() < wanted && refused < kPatience; ++refused) {
    const int x = static_cast<int>(rng.below(static_cast<std::uint32_t>(relief.width())));
    const int y = static_cast<int>(rng.below(static_cast<std::uint32_t>(relief.height())));
    const int turn = static_cast<int>(rng.below(4));
    const int what = static_cast<int>(rng.below(6));
    const Cell cell{x, y};
    bool found = false;
    if (kind == ArenaKind::Orange) {
      found = lay_field(what < 3 ? "stepfield_orange_diagonal" : "crossing_ramps", cell, turn, site, laid);
    } else if (what < 3) {
      found = laid.size() + 2 <= wanted && lay_tower(what, cell, turn, site, laid);
    } else if (what == 3) {
      found = lay_tunnel(cell, site, laid);
    } else {
      found = lay_field("stepfield_red_diagonal", cell, turn, site, laid);
    }
    if (found) refused = 0;
  }
  return laid;
}

}  // namespace rubble::arenas
