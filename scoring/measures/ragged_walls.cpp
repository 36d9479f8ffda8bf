#include "scoring/measures/ragged_walls.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <opencv2/core.hpp>
#include <optional>

namespace rubble::scoring {
namespace {

constexpr double kLength = 0.35;   // of a wall in full [m]
constexpr double kWaver = 0.10;    // to either side of its line [m]
constexpr double kFilled = 0.7;    // share of the columns along the line that hold a cell of it
constexpr double kAlone = 0.15;    // beside that band nearly nothing stands [m]
constexpr double kStray = 0.03;    // share of the cells there that may be walls
constexpr double kMostWork = 2e8;  // cells looked at
constexpr double kSlopes[] = {-1.0, -0.5, 0.0, 0.5, 1.0};

/// The grid along lines of one direction: columns lie along it, rows across.
class Band {
 public:
  Band(const OccupancyGrid& grid, bool along_y, double slope)
      : grid_(grid),
        along_y_(along_y),
        slope_(slope),
        half_(std::max(1, static_cast<int>(std::lround(0.5 * kLength / grid.resolution())))),
        waver_(std::max(1, static_cast<int>(std::lround(kWaver / grid.resolution())))),
        alone_(std::max(1, static_cast<int>(std::lround(kAlone / grid.resolution())))) {}

  /// Whether the line through `at` is a wall in full that stands alone.
  bool filled(const Cell& at) const {
    int columns = 0;
    for (int k = -half_; k <= half_; ++k) columns += in_column(at, k) ? 1 : 0;
    if (columns < kFilled * (2 * half_ + 1)) return false;
    int beside = 0;
    for (int k = -half_; k <= half_; ++k)
      for (int row = waver_ + 1; row <= waver_ + alone_; ++row)
        for (const int side : {-row, row}) beside += wall(at, k, middle(k) + side) ? 1 : 0;
    return beside <= kStray * 2 * alone_ * (2 * half_ + 1);
  }
  /// Cells that filled() may look at.
  double work() const { return (2.0 * half_ + 1.0) * (2.0 * (waver_ + alone_) + 1.0); }
  /// The wall cells ahead, of each column that nearest to the line.
  void ahead(const Cell& at, std::vector<std::pair<Cell, Cell>>& out) const {
    for (int k = 1; k <= half_; ++k)
      if (const auto cell = in_column(at, k)) out.emplace_back(at, *cell);
  }

 private:
  std::optional<Cell> in_column(const Cell& at, int k) const {
    for (int off = 0; off <= waver_; ++off)
      for (const int row : {middle(k) - off, middle(k) + off})
        if (wall(at, k, row)) return cell(at, k, row);
    return std::nullopt;
  }
  int middle(int k) const { return static_cast<int>(std::lround(slope_ * k)); }
  Cell cell(const Cell& at, int k, int row) const {
    return along_y_ ? Cell{at.x + row, at.y + k} : Cell{at.x + k, at.y + row};
  }
  bool wall(const Cell& at, int k, int row) const {
    const Cell c = cell(at, k, row);
    return grid_.inside(c) && grid_[c] == Occupancy::Occupied;
  }

  const OccupancyGrid& grid_;
  bool along_y_;
  double slope_;
  int half_;
  int waver_;
  int alone_;
};

}  // namespace

std::vector<std::pair<Cell, Cell>> ragged_walls(const OccupancyGrid& grid, const cv::Mat& is_small) {
  std::vector<std::pair<Cell, Cell>> out;
  const double all = cv::countNonZero(is_small) * Band(grid, false, 0.0).work() * 2.0 * std::size(kSlopes);
  if (all > kMostWork) return out;
  for (const bool along_y : {false, true})
    for (const double slope : kSlopes) {
      const Band band(grid, along_y, slope);
      for (int y = 0; y < grid.height(); ++y)
        for (int x = 0; x < grid.width(); ++x) {
          if (is_small.at<unsigned char>(y, x) == 0 || !band.filled({x, y})) continue;
          band.ahead({x, y}, out);
        }
    }
  return out;
}

}  // namespace rubble::scoring
