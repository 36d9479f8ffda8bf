#include "scoring/measures/wall_pieces.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "scoring/measures/dashes.h"
#include "scoring/measures/ragged_walls.h"

namespace rubble::scoring {
namespace {

constexpr double kWholeWall = 0.35;  // extent from which a piece is a wall in full [m]
constexpr double kJoin = 0.05;       // rim around a piece, a cell at least [m]
constexpr double kCoarse = 0.055;    // cells that walls may be thinner than [m]
constexpr double kBridge = 0.13;     // longest gap in a line that is thinner than a cell [m]
constexpr double kSpeck = 0.15;      // cells one after the other: less joins nothing [m]

/// Connected pieces of a mask and their extents.
struct Pieces {
  explicit Pieces(const cv::Mat& mask) {
    cv::Mat centres;
    cv::connectedComponentsWithStats(mask, labels, stats, centres, 8);
  }
  int at(std::size_t i) const { return labels.ptr<int>(0)[i]; }
  int cells(int piece) const { return stats.at<int>(piece, cv::CC_STAT_AREA); }
  /// Diagonal of the bounding box [cells].
  double extent(int piece) const {
    return std::hypot(stats.at<int>(piece, cv::CC_STAT_WIDTH), stats.at<int>(piece, cv::CC_STAT_HEIGHT));
  }
  cv::Mat labels;
  cv::Mat stats;
};

/// Non-zero: a wall of a piece that is none in full.
cv::Mat small_pieces(const OccupancyGrid& grid, const Pieces& pieces) {
  cv::Mat out(grid.height(), grid.width(), CV_8U, cv::Scalar(0));
  for (std::size_t i = 0; i < grid.cells().size(); ++i)
    if (grid.cells()[i] == Occupancy::Occupied && pieces.extent(pieces.at(i)) * grid.resolution() < kWholeWall)
      out.data[i] = 1;
  return out;
}

/// Fills the gaps in lines thinner than a cell, up to `longest` cells: no wall in the column (row) here and beside, but
/// in one before and one behind. Ends stay where they are.
void bridge(cv::Mat& walls, int longest) {
  cv::Mat column;  // a wall here, above or below
  cv::Mat row;     // a wall here, left or right
  cv::dilate(walls, column, cv::Mat::ones(3, 1, CV_8U));
  cv::dilate(walls, row, cv::Mat::ones(1, 3, CV_8U));
  const auto is_gap = [longest](const unsigned char* at, std::ptrdiff_t stride, int before, int behind) {
    if (*at != 0) return false;
    int back = 1;
    while (back <= std::min(longest, before) && at[-back * stride] == 0) ++back;
    if (back > std::min(longest, before)) return false;
    for (int ahead = 1; ahead <= std::min(longest + 1 - back, behind); ++ahead)
      if (at[ahead * stride] != 0) return true;
    return false;
  };
  for (int y = 0; y < walls.rows; ++y)
    for (int x = 0; x < walls.cols; ++x)
      if (is_gap(column.ptr<unsigned char>(y) + x, 1, x, walls.cols - 1 - x) ||
          is_gap(row.ptr<unsigned char>(y) + x, static_cast<std::ptrdiff_t>(row.step), y, walls.rows - 1 - y))
        walls.ptr<unsigned char>(y)[x] = 255;
}

}  // namespace

WallPieces wall_pieces(const OccupancyGrid& grid, Ragged ragged) {
  WallPieces out{Grid<float>(grid.frame())};
  if (grid.cells().empty()) return out;
  cv::Mat walls(grid.height(), grid.width(), CV_8U);
  for (std::size_t i = 0; i < grid.cells().size(); ++i)
    walls.data[i] = grid.cells()[i] == Occupancy::Occupied ? 255 : 0;
  const Pieces raw(walls);
  const double least_cells = std::max(2.0, std::floor(kSpeck / grid.resolution()));
  const auto dashes = dashes_in_line(grid);
  std::vector<bool> is_dash(static_cast<std::size_t>(raw.stats.rows), false);
  for (const auto& [from, to] : dashes)
    for (const Cell& end : {from, to}) is_dash[static_cast<std::size_t>(raw.labels.at<int>(end.y, end.x))] = true;
  cv::Mat joined = walls.clone();
  for (std::size_t i = 0; i < grid.cells().size(); ++i)
    if (walls.data[i] != 0 && raw.cells(raw.at(i)) < least_cells && !is_dash[static_cast<std::size_t>(raw.at(i))])
      joined.data[i] = 0;
  for (const auto& [from, to] : dashes) cv::line(joined, {from.x, from.y}, {to.x, to.y}, 255);
  if (ragged == Ragged::AreWalls)
    for (const auto& [from, to] : ragged_walls(grid, small_pieces(grid, raw)))
      cv::line(joined, {from.x, from.y}, {to.x, to.y}, 255);
  const int reach = std::max(1, static_cast<int>(std::lround(kJoin / grid.resolution())));
  if (grid.resolution() > kCoarse) bridge(joined, static_cast<int>(kBridge / grid.resolution()));
  cv::morphologyEx(joined, joined, cv::MORPH_CLOSE,
                   cv::getStructuringElement(cv::MORPH_RECT, {2 * reach + 1, 2 * reach + 1}));
  const Pieces whole(joined);
  const auto strength = [&](double extent_cells) {
    return static_cast<float>(std::min(1.0, extent_cells * grid.resolution() / kWholeWall));
  };
  for (std::size_t i = 0; i < grid.cells().size(); ++i) {
    if (joined.data[i] == 0 && walls.data[i] == 0) continue;
    const float alone = walls.data[i] != 0 ? strength(raw.extent(raw.at(i))) : 0.0f;
    const float together = whole.at(i) > 0 ? strength(whole.extent(whole.at(i))) : 0.0f;
    out.strength.cells()[i] = std::max(alone, together);
  }
  return out;
}

}  // namespace rubble::scoring
