#include "explore/caution/pallet_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/angle.h"
#include "base/planar.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;

constexpr int kReach = 6;            ///< cells that make up a piece of wall lie so near each other [cells]
constexpr int kFewest = 5;           ///< such cells, for a direction
constexpr double kStraight = 0.9;    ///< how much of the spread of a piece lies along it
constexpr double kAgreement = 0.5;   ///< of directions and of places, 0 to 1
constexpr std::size_t kPieces = 60;  ///< fewer pieces say nothing
constexpr double kAlong = 0.2;       ///< a piece this far off the grid's axes is no wall on it [rad]

/// A piece of wall about one occupied cell.
struct Piece {
  TPoint2D p_map;
  double direction;  ///< [rad]
};

/// The occupied cells of a part of a map, row by row.
class OccupiedRows {
 public:
  OccupiedRows(const OccupancyGrid& cells, Cell low, Cell high) : lowest_(low.y) {
    for (int y = low.y; y <= high.y; ++y) {
      first_.push_back(xs_.size());
      for (int x = low.x; x <= high.x; ++x)
        if (cells[{x, y}] == Occupancy::Occupied) xs_.push_back(x);
    }
    first_.push_back(xs_.size());
  }
  int lowest() const { return lowest_; }
  int highest() const { return lowest_ + static_cast<int>(first_.size()) - 2; }
  /// Those of row y from x on.
  const int* from(int y, int x) const { return std::lower_bound(begin(y), end(y), x); }
  const int* begin(int y) const { return xs_.data() + first_[static_cast<std::size_t>(y - lowest_)]; }
  const int* end(int y) const { return xs_.data() + first_[static_cast<std::size_t>(y - lowest_) + 1]; }

 private:
  int lowest_;
  std::vector<int> xs_;
  std::vector<std::size_t> first_;  ///< of each row
};

std::optional<Piece> piece_at(const OccupiedRows& occupied, Cell c, const TPoint2D& centre) {
  TPoint2D sum;
  double xx = 0.0, yy = 0.0, xy = 0.0;
  int count = 0;
  for (int y = std::max(occupied.lowest(), c.y - kReach); y <= std::min(occupied.highest(), c.y + kReach); ++y)
    for (const int* x = occupied.from(y, c.x - kReach); x != occupied.end(y) && *x <= c.x + kReach; ++x) {
      const double dx = *x - c.x, dy = y - c.y;
      sum += TPoint2D{dx, dy};
      xx += dx * dx;
      yy += dy * dy;
      xy += dx * dy;
      ++count;
    }
  if (count < kFewest) return std::nullopt;
  xx -= sum.x * sum.x / count;
  yy -= sum.y * sum.y / count;
  xy -= sum.x * sum.y / count;
  const double spread = length(xx - yy, 2.0 * xy);
  if (spread < kStraight * (xx + yy)) return std::nullopt;
  return Piece{centre, 0.5 * std::atan2(2.0 * xy, xx - yy)};
}

/// Mean of angles that stand `turns` times in a circle; nothing where they do not agree.
class CircularMean {
 public:
  void add(double angle) {
    x_ += std::cos(angle);
    y_ += std::sin(angle);
    ++count_;
  }
  std::optional<double> mean() const {
    if (count_ == 0 || length(x_, y_) < kAgreement * count_) return std::nullopt;
    return std::atan2(y_, x_);
  }

 private:
  double x_ = 0.0, y_ = 0.0;
  int count_ = 0;
};

}  // namespace

TPoint2D PalletGrid::to_grid(const TPoint2D& p) const {
  const double c = std::cos(angle), s = std::sin(angle);
  return {(c * p.x + s * p.y - east) / size, (c * p.y - s * p.x - north) / size};
}

TPoint2D PalletGrid::to_map(const TPoint2D& p_grid) const {
  const double c = std::cos(angle), s = std::sin(angle);
  const double x = p_grid.x * size + east, y = p_grid.y * size + north;
  return {c * x - s * y, s * x + c * y};
}

Cell PalletGrid::pallet(const TPoint2D& p_map) const {
  const TPoint2D p = to_grid(p_map);
  return {static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y))};
}

double PalletGrid::depth(const TPoint2D& p_map) const {
  const TPoint2D p = to_grid(p_map);
  const auto to_edge = [](double x) { return std::min(x - std::floor(x), std::ceil(x) - x); };
  return size * std::min(to_edge(p.x), to_edge(p.y));
}

std::optional<PalletGrid> find_pallets(const OccupancyGrid& cells, double size, const TPoint2D& around, double radius) {
  std::vector<Piece> pieces;
  CircularMean direction;
  if (cells.width() == 0 || cells.height() == 0) return std::nullopt;
  const auto within = [&](Cell c) {
    return Cell{std::clamp(c.x, 0, cells.width() - 1), std::clamp(c.y, 0, cells.height() - 1)};
  };
  const Cell low = cells.cell({around.x - radius, around.y - radius});
  const Cell high = cells.cell({around.x + radius, around.y + radius});
  const OccupiedRows occupied(cells, within({low.x - kReach, low.y - kReach}),
                              within({high.x + kReach, high.y + kReach}));
  for (int y = std::max(0, low.y); y <= std::min(cells.height() - 1, high.y); ++y)
    for (const int* x = occupied.from(y, low.x); x != occupied.end(y) && *x <= high.x; ++x)
      if (const auto piece = piece_at(occupied, {*x, y}, cells.centre({*x, y}))) {
        pieces.push_back(*piece);
        direction.add(4.0 * piece->direction);
      }
  const auto four = direction.mean();
  if (pieces.size() < kPieces || !four) return std::nullopt;
  PalletGrid grid;
  grid.size = size;
  grid.angle = *four / 4.0;
  std::array<CircularMean, 2> place;  // of walls across x, across y
  for (const Piece& piece : pieces) {
    const TPoint2D p = grid.to_grid(piece.p_map);
    const double off = wrap_angle(2.0 * (piece.direction - grid.angle)) / 2.0;
    if (std::abs(off) < kAlong) place[1].add(2.0 * kPi * p.y);
    if (std::abs(off) > 0.5 * kPi - kAlong) place[0].add(2.0 * kPi * p.x);
  }
  const auto across_x = place[0].mean(), across_y = place[1].mean();
  if (!across_x || !across_y) return std::nullopt;
  grid.east = *across_x / (2.0 * kPi) * size;
  grid.north = *across_y / (2.0 * kPi) * size;
  return grid;
}

}  // namespace rubble::explore
