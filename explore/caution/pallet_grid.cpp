#include "explore/caution/pallet_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
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
  TPoint2D twice;  ///< unit vector at twice the angle of its direction: the same both ways along it
};

/// The unit vector at twice the angle of one.
TPoint2D doubled(const TPoint2D& unit) { return {unit.x * unit.x - unit.y * unit.y, 2.0 * unit.x * unit.y}; }

/// Mean of angles in a circle; nothing where they do not agree.
class CircularMean {
 public:
  void add(double angle) { add(TPoint2D{std::cos(angle), std::sin(angle)}); }
  void add(const TPoint2D& unit) {
    x_ += unit.x;
    y_ += unit.y;
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

/// The occupied cells about one that moves along a row, and what they spread: cells are counted as they come within
/// reach and as they leave it. Sums of whole numbers, exact.
class Surroundings {
 public:
  /// `y` must be one of the rows.
  Surroundings(const WallsAbout& walls, int y) {
    const int top = std::min(walls.highest_, y + kReach);
    for (int row = std::max(walls.lowest_, y - kReach); row <= top; ++row)
      rows_.push_back({row - y, walls.begin(row), walls.begin(row), walls.end(row)});
  }
  /// Moves to a cell no farther left than before.
  void move_to(int x) {
    for (Row& row : rows_) {
      for (; row.ahead != row.end && *row.ahead <= x + kReach; ++row.ahead) count(*row.ahead, row.dy, 1);
      for (; row.behind != row.ahead && *row.behind < x - kReach; ++row.behind) count(*row.behind, row.dy, -1);
    }
    x_ = x;
  }
  /// The piece of wall that they make up: unit vector at twice the angle of its direction. Nothing where they make up
  /// none.
  std::optional<TPoint2D> twice_the_direction() const {
    if (n_ < kFewest) return std::nullopt;
    const auto dx = static_cast<double>(sum_x_ - n_ * x_), dy = static_cast<double>(sum_y_);
    const auto n = static_cast<double>(n_);
    const double xx = static_cast<double>(sum_xx_ - 2 * x_ * sum_x_ + n_ * x_ * x_) - dx * dx / n;
    const double yy = static_cast<double>(sum_yy_) - dy * dy / n;
    const double xy = static_cast<double>(sum_xy_ - x_ * sum_y_) - dx * dy / n;
    const double spread = length(xx - yy, 2.0 * xy);
    if (spread < kStraight * (xx + yy)) return std::nullopt;
    return TPoint2D{(xx - yy) / spread, 2.0 * xy / spread};
  }

 private:
  struct Row {
    int dy;
    const int *behind, *ahead, *end;  ///< within reach: from `behind` to before `ahead`
  };
  void count(std::int64_t x, std::int64_t dy, std::int64_t sign) {
    n_ += sign;
    sum_x_ += sign * x;
    sum_y_ += sign * dy;
    sum_xx_ += sign * x * x;
    sum_yy_ += sign * dy * dy;
    sum_xy_ += sign * x * dy;
  }

  std::vector<Row> rows_;
  std::int64_t x_ = 0, n_ = 0, sum_x_ = 0, sum_y_ = 0, sum_xx_ = 0, sum_yy_ = 0, sum_xy_ = 0;  // dy from the row
};

void PalletGrid::turn_to(double angle) {
  angle_ = angle;
  cosine_ = std::cos(angle);
  sine_ = std::sin(angle);
}

TPoint2D PalletGrid::to_grid(const TPoint2D& p) const {
  return {(cosine_ * p.x + sine_ * p.y - east) / size, (cosine_ * p.y - sine_ * p.x - north) / size};
}

TPoint2D PalletGrid::to_map(const TPoint2D& p_grid) const {
  const double x = p_grid.x * size + east, y = p_grid.y * size + north;
  return {cosine_ * x - sine_ * y, sine_ * x + cosine_ * y};
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

WallsAbout::WallsAbout(const OccupancyGrid& cells, const TPoint2D& around, double radius)
    : frame_(cells.frame()),
      low_(cells.cell({around.x - radius, around.y - radius})),
      high_(cells.cell({around.x + radius, around.y + radius})),
      lowest_(std::max(0, low_.y - kReach)),
      highest_(std::min(cells.height() - 1, high_.y + kReach)) {
  const int left = std::max(0, low_.x - kReach), right = std::min(cells.width() - 1, high_.x + kReach);
  for (int y = lowest_; y <= highest_; ++y) {
    first_.push_back(xs_.size());
    // Most cells are none of a wall: memchr passes over many at a time.
    const Occupancy* const of_row = cells.row(y);
    const auto next = [&](int x) {
      const void* const found = x > right ? nullptr
                                          : std::memchr(of_row + x, static_cast<int>(Occupancy::Occupied),
                                                        static_cast<std::size_t>(right - x + 1));
      return found == nullptr ? right + 1 : static_cast<int>(static_cast<const Occupancy*>(found) - of_row);
    };
    for (int x = next(left); x <= right; x = next(x + 1)) xs_.push_back(x);
  }
  first_.push_back(xs_.size());
}

std::optional<PalletGrid> WallsAbout::pallets(double size) const {
  std::vector<Piece> pieces;
  CircularMean direction;
  for (int y = std::max(lowest_, low_.y); y <= std::min(highest_, high_.y); ++y) {
    Surroundings about(*this, y);
    for (const int* x = std::lower_bound(begin(y), end(y), low_.x); x != end(y) && *x <= high_.x; ++x) {
      about.move_to(*x);
      if (const auto twice = about.twice_the_direction()) {
        pieces.push_back({frame_.centre({*x, y}), *twice});
        direction.add(doubled(*twice));
      }
    }
  }
  const auto four = direction.mean();
  if (pieces.size() < kPieces || !four) return std::nullopt;
  PalletGrid grid;
  grid.size = size;
  grid.turn_to(*four / 4.0);
  std::array<CircularMean, 2> place;  // of walls across x, across y
  const TPoint2D axis = doubled(grid.direction());
  const double along = std::cos(2.0 * kAlong);
  for (const Piece& piece : pieces) {
    const TPoint2D p = grid.to_grid(piece.p_map);
    const double off = axis.x * piece.twice.x + axis.y * piece.twice.y;  // cosine of twice the angle between them
    if (off > along) place[1].add(2.0 * kPi * p.y);
    if (off < -along) place[0].add(2.0 * kPi * p.x);
  }
  const auto across_x = place[0].mean(), across_y = place[1].mean();
  if (!across_x || !across_y) return std::nullopt;
  grid.east = *across_x / (2.0 * kPi) * size;
  grid.north = *across_y / (2.0 * kPi) * size;
  return grid;
}

std::optional<PalletGrid> find_pallets(const OccupancyGrid& cells, double size, const TPoint2D& around, double radius) {
  return WallsAbout(cells, around, radius).pallets(size);
}

}  // namespace rubble::explore
