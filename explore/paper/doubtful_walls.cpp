#include "explore/paper/doubtful_walls.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "base/planar.h"
#include "explore/caution/local_grids.h"
#include "explore/caution/pallet_grid.h"
#include "explore/plan/frontier.h"
#include "explore/plan/set_bytes.h"
#include "explore/search/searched_area.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;

constexpr double kShortest = 0.5;           ///< row [m]
constexpr int kGap = 2;                     ///< cells that may be missing in a row
constexpr double kBefore = 0.15;            ///< free floor before it [m]
constexpr double kBehind = 0.80;            ///< within this behind it ... [m]
constexpr double kHidden = 0.25;            ///< ... so much is unknown [m]
constexpr double kFrontier = 0.5;           ///< of floor that is shut off [m]
constexpr float kHalfBody = 0.25F;          ///< a lane that is no wider on either side is none [m]
constexpr double kThick = 0.10;             ///< [m]
constexpr double kOffEdges = 0.25;          ///< [m]
constexpr double kAsThick = 0.25;           ///< floor of a slope, and a wall is drawn no thicker [m]
constexpr double kSoft = 0.8;               ///< of a row on an edge that is no sure wall
constexpr double kLookFrom[] = {0.5, 0.6};  ///< [m]
constexpr int kStride = 3;                  ///< places to look from are so many cells apart along the wall

bool free_before(const OccupancyGrid& cells, Cell c, Cell n, int cells_before) {
  for (int i = 1; i <= cells_before; ++i) {
    const Cell at{c.x - i * n.x, c.y - i * n.y};
    if (!cells.inside(at) || cells[at] != Occupancy::Free) return false;
  }
  return true;
}

/// Numbers from 1 on for the pieces of free floor, each in one; 0: no floor, nor is the rim. What no body gets through
/// does not join them: all else belongs to the piece that is nearest along the floor.
Grid<int> pieces_of_floor(const Traversable& floor) {
  constexpr int kWide = -1, kNarrow = -2;
  Grid<int> pieces(floor.frame());
  const int width = pieces.width();
  for (int y = 1; y + 1 < pieces.height(); ++y) {
    const Occupancy* const cells = floor.cells.row(y);
    const float* const clearance = floor.clearance.row(y);
    int* const row = pieces.row(y);
    for (int x = 1; x + 1 < width; ++x) {  // free of branches, so that compilers use vector code
      const int free = cells[x] == Occupancy::Free ? 1 : 0;
      const int wide = clearance[x] >= kHalfBody ? 1 : 0;
      row[x] = free * (kNarrow + wide * (kWide - kNarrow));
    }
  }
  int* const piece = pieces.data();
  // Cells by index, in the order in which they were reached; one more, for what spread() writes in vain.
  std::vector<int> open(pieces.cells().size() + 1);
  std::size_t end = 0;
  const auto spread = [&](std::size_t from, int what) {
    for (std::size_t i = from; i < end; ++i) {
      const int number = piece[open[i]];
      // Without branches: whether a neighbour is new would be mispredicted for every other cell.
      for (const int step : {1, width, -1, -width}) {
        const int next = open[i] + step;
        const bool is_new = piece[next] == what;
        piece[next] = is_new ? number : piece[next];
        open[end] = next;
        end += is_new ? 1 : 0;
      }
    }
  };
  int number = 0;
  const auto number_all = [&](int what) {
    const int* const last = piece + pieces.cells().size();
    for (const int* at = piece; (at = std::find(at, last, what)) != last;) {
      const auto i = static_cast<std::size_t>(at - piece);
      piece[i] = ++number;
      open[end++] = static_cast<int>(i);
      spread(end - 1, what);
    }
  };
  number_all(kWide);
  spread(0, kNarrow);
  number_all(kNarrow);
  return pieces;
}

/// The row of a face that begins at a cell: on along it, a cell to either side, over small gaps. Takes it out of the
/// face.
std::vector<Cell> row_from(Cell first, Cell along, Cell n, Grid<std::uint8_t>& face) {
  const auto next_of = [&](Cell c) -> std::optional<Cell> {
    for (int step = 1; step <= 1 + kGap; ++step)
      for (const int aside : {0, 1, -1}) {
        const Cell next{c.x + step * along.x + aside * n.x, c.y + step * along.y + aside * n.y};
        if (face.inside(next) && face[next] != 0) return next;
      }
    return std::nullopt;
  };
  std::vector<Cell> row;
  for (std::optional<Cell> next = first; next; next = next_of(row.back())) {
    face[*next] = 0;
    row.push_back(*next);
  }
  return row;
}

/// How far a wall at `p` whose normal is `n` stands off the nearest edges of pallets that it could stand on [m].
double off_edges(const PalletGrid& grid, const TPoint2D& p, Cell n) {
  const TPoint2D at = grid.to_grid(p);
  const bool along_x = std::abs(grid.direction().x * n.x + grid.direction().y * n.y) > std::sqrt(0.5);
  const double x = along_x ? at.x : at.y;
  return grid.size * std::abs(x - std::round(x));
}

/// What lies behind walls. Floor of a slope is drawn as a thick wall or as several, with ground between them that was
/// seen over the first.
class Background {
 public:
  Background(const Traversable& floor, double pallet, LocalGrids& grids, const Grid<std::uint8_t>* pockets)
      : floor_(floor),
        cells_(floor.cells),
        grids_(grids),
        pockets_(pockets),
        thick_(in_cells(kThick)),
        behind_(in_cells(kBehind)),
        hidden_(in_cells(kHidden)),
        half_element_(in_cells(pallet) * in_cells(pallet) / 2),
        frontier_(in_cells(kFrontier)) {}

  /// Whether `n` leads from the face of a wall at `c` to unknown ground, and before that neither to the floor that the
  /// face stands on nor to a wall on an edge. What takes longest is asked last: whether floor hangs together, for all.
  bool hidden(Cell c, Cell n) {
    int steps = steps_to_unknown(c, n);
    if (steps == 0 && !on_edge(c, n)) steps = steps_to_other_floor(c, n);
    return steps > 0 && !walls_on_edge(c, n, steps) && !same_floor(c, n, steps);
  }

 private:
  /// How large a piece of floor is, and the frontier it has [cells].
  struct Piece {
    int cells = 0;
    int frontier = 0;
  };

  int in_cells(double length) const { return static_cast<int>(std::lround(length / cells_.frame().resolution)); }

  /// Cells from `c` on until enough is unknown, or the map ends; 0: neither.
  int steps_to_unknown(Cell c, Cell n) const {
    int unknown = 0;
    for (int i = 1; i <= behind_; ++i) {
      const Cell at{c.x + i * n.x, c.y + i * n.y};
      if (!cells_.inside(at)) return i;
      if (i <= thick_ || cells_[at] != Occupancy::Unknown) continue;
      const bool pocket = pockets_ != nullptr && (*pockets_)[at] != 0;
      if (!pocket && ++unknown >= hidden_) return i;
    }
    return 0;
  }
  /// The same until so much of it is floor of another piece that is worth it: seen from upon the slope, and shut off
  /// when it was looked up again from its foot.
  int steps_to_other_floor(Cell c, Cell n) {
    const int here = piece_before(c, n);
    int other = 0;
    for (int i = thick_ + 1; i <= behind_; ++i) {
      const Cell at{c.x + i * n.x, c.y + i * n.y};
      if (!cells_.inside(at)) return 0;
      const int piece = pieces_[at];
      if (piece != 0 && piece != here && worth_it(piece) && ++other >= hidden_) return i;
    }
    return 0;
  }
  /// As large as half an element, with a frontier.
  bool worth_it(int piece) const {
    const Piece& it = extents_[static_cast<std::size_t>(piece)];
    return it.cells >= half_element_ && it.frontier >= frontier_;
  }
  /// The piece of floor that the face of a wall stands on.
  int piece_before(Cell c, Cell n) {
    if (pieces_.width() == 0) measure_pieces();
    return pieces_[{c.x - n.x, c.y - n.y}];
  }
  void measure_pieces() {
    pieces_ = pieces_of_floor(floor_);
    const std::vector<int>& cells = pieces_.cells();
    extents_.resize(static_cast<std::size_t>(*std::max_element(cells.begin(), cells.end())) + 1);
    // Runs of one piece, for the counter of a cell would have to wait for that of the cell before.
    for (auto run = cells.begin(); run != cells.end();) {
      const auto end = std::find_if(run, cells.end(), [piece = *run](int other) { return other != piece; });
      extents_[static_cast<std::size_t>(*run)].cells += static_cast<int>(end - run);
      run = end;
    }
    for (const Cell c : frontier_cells(floor_)) ++extents_[static_cast<std::size_t>(pieces_[c])].frontier;
  }
  bool walls_on_edge(Cell c, Cell n, int steps) const {
    for (int i = 1; i <= steps; ++i) {
      const Cell at{c.x + i * n.x, c.y + i * n.y};
      if (cells_.inside(at) && cells_[at] == Occupancy::Occupied && on_edge(at, n)) return true;
    }
    return false;
  }
  bool on_edge(Cell c, Cell n) const {
    if (floor_.unsure[c] != 0) return false;
    const std::optional<PalletGrid>& grid = grids_.at(cells_.centre(c));
    return !grid || off_edges(*grid, cells_.centre(c), n) < kOnAnEdge;
  }
  bool same_floor(Cell c, Cell n, int steps) {
    const int here = piece_before(c, n);
    for (int i = thick_ + 1; i <= steps; ++i) {
      const Cell at{c.x + i * n.x, c.y + i * n.y};
      if (cells_.inside(at) && pieces_[at] == here) return true;
    }
    return false;
  }

  const Traversable& floor_;
  const OccupancyGrid& cells_;
  LocalGrids& grids_;
  const Grid<std::uint8_t>* pockets_;
  int thick_, behind_, hidden_;  ///< [cells]
  int half_element_;             ///< [cells]
  int frontier_;                 ///< [cells]
  Grid<int> pieces_;             ///< of floor, once they are asked for
  std::vector<Piece> extents_;
};

/// Whether most of a row was met from near.
bool is_solid(const Traversable& floor, const std::vector<Cell>& row) {
  const auto solid = std::count_if(row.begin(), row.end(), [&](Cell c) { return floor.solid[c] != 0; });
  return 2 * static_cast<std::size_t>(solid) >= row.size();
}

/// Whether a row of cells and what is drawn right behind it was passed by a good part of the scans.
bool is_soft(const Traversable& floor, const std::vector<Cell>& row, Cell n, int thick) {
  const auto soft = std::count_if(row.begin(), row.end(), [&](Cell c) {
    for (int i = 0; i <= thick; ++i) {
      const Cell at{c.x + i * n.x, c.y + i * n.y};
      if (floor.cells.inside(at) && floor.cells[at] == Occupancy::Occupied && floor.unsure[at] == 0) return false;
    }
    return true;
  });
  return static_cast<double>(soft) >= kSoft * static_cast<double>(row.size());
}

}  // namespace

std::vector<Source> doubtful_walls(const Traversable& floor, double pallet, const Grid<std::uint8_t>* pockets,
                                   KnownGrids* known) {
  std::vector<Source> sources;
  if (pallet <= 0.0 || floor.cells.width() == 0) return sources;
  const OccupancyGrid& cells = floor.cells;
  const double resolution = floor.frame().resolution;
  const auto in_cells = [&](double length) { return static_cast<int>(std::lround(length / resolution)); };
  const int before = std::max(1, in_cells(kBefore));
  LocalGrids grids(cells, pallet, known);
  Background background(floor, pallet, grids, pockets);
  std::vector<Cell> occupied;
  for (int y = 1; y + 1 < cells.height(); ++y)
    for_each_occupied(cells.row(y), 1, cells.width() - 1, [&](int x) { occupied.push_back({x, y}); });
  Grid<std::uint8_t> face(floor.frame());
  // `n` points from the free side into the wall.
  for (const Cell n : {Cell{1, 0}, Cell{0, 1}, Cell{-1, 0}, Cell{0, -1}}) {
    const Cell along{std::abs(n.y), std::abs(n.x)};
    for (const Cell c : occupied) face[c] = free_before(cells, c, n, before) && background.hidden(c, n);
    for (const Cell c : occupied) {
      if (face[c] == 0) continue;
      const std::vector<Cell> row = row_from(c, along, n, face);
      const int length = std::abs(row.back().x - c.x) * along.x + std::abs(row.back().y - c.y) * along.y + 1;
      if (length < in_cells(kShortest) || is_solid(floor, row)) continue;
      const TPoint2D middle = cells.centre(row[row.size() / 2]);
      const std::optional<PalletGrid>& grid = grids.at(middle);
      if (!grid) continue;
      if (off_edges(*grid, middle, n) < kOffEdges && !is_soft(floor, row, n, in_cells(kAsThick))) continue;
      for (std::size_t i = 0; i < row.size(); i += kStride)
        for (const double distance : kLookFrom) {
          const int away = in_cells(distance);
          const Cell from{row[i].x - away * n.x, row[i].y - away * n.y};
          if (!cells.inside(from) || cells[from] != Occupancy::Free) continue;
          if (in_sight(floor, from, {row[i].x - n.x, row[i].y - n.y})) sources.push_back({from, 0.0});
        }
    }
  }
  return sources;
}

}  // namespace rubble::explore
