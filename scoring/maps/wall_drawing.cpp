#include "scoring/maps/wall_drawing.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

namespace rubble::scoring {
namespace {

constexpr double kSlit = 0.2;          // [m]
constexpr double kLeastShare = 0.2;    // of the free space that walls enclose, else they are none around it
constexpr double kLeastInside = 0.25;  // [m^2]

cv::Mat mask_of(const OccupancyGrid& grid, Occupancy kind) {
  cv::Mat mask(grid.height(), grid.width(), CV_8U);
  for (std::size_t i = 0; i < grid.cells().size(); ++i) mask.data[i] = grid.cells()[i] == kind ? 255 : 0;
  return mask;
}

bool touches_rim(const cv::Mat& mask) {
  return cv::countNonZero(mask.row(0)) + cv::countNonZero(mask.row(mask.rows - 1)) + cv::countNonZero(mask.col(0)) +
             cv::countNonZero(mask.col(mask.cols - 1)) >
         0;
}

/// 255 where the flood from the rim comes. Slits are closed against it, and it gets back what closing took.
cv::Mat outside_of(const cv::Mat& walls, double resolution) {
  const int reach = static_cast<int>(std::ceil(0.5 * kSlit / resolution));
  const cv::Mat brush = cv::getStructuringElement(cv::MORPH_RECT, {2 * reach + 1, 2 * reach + 1});
  const int border = reach + 1;
  cv::Mat closed;
  cv::copyMakeBorder(walls, closed, border, border, border, border, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::morphologyEx(closed, closed, cv::MORPH_CLOSE, brush);
  cv::floodFill(closed, cv::Point(0, 0), cv::Scalar(128));
  cv::Mat outside = closed(cv::Rect(border, border, walls.cols, walls.rows)) == 128;
  cv::dilate(outside, outside, brush);
  outside.setTo(0, walls);
  return outside;
}

}  // namespace

FloodedDrawing flood_drawing(OccupancyGrid grid) {
  FloodedDrawing out;
  const auto count = [&](Occupancy kind) { return std::count(grid.cells().begin(), grid.cells().end(), kind); };
  const auto free = count(Occupancy::Free);
  const bool only_walls = free == 0;
  const bool no_unknown = count(Occupancy::Unknown) == 0;
  if (only_walls == no_unknown || count(Occupancy::Occupied) == 0) {  // full maps, and those of one class
    out.grid = std::move(grid);
    return out;
  }
  const cv::Mat walls = mask_of(grid, Occupancy::Occupied);
  const cv::Mat outside = outside_of(walls, grid.resolution());
  const auto cells = static_cast<double>(grid.cells().size());
  const double inside = cells - cv::countNonZero(outside) - cv::countNonZero(walls);
  if (only_walls) {
    const bool encloses = inside * grid.resolution() * grid.resolution() >= kLeastInside;
    out.note = encloses ? "walls only: what they enclose counts as free"
                        : std::string("walls only, and they enclose nothing: ") + kFreeNotKnown;
    if (encloses)
      for (std::size_t i = 0; i < grid.cells().size(); ++i)
        if (outside.data[i] == 0 && walls.data[i] == 0) grid.cells()[i] = Occupancy::Free;
  } else if (!touches_rim(walls) && inside >= kLeastShare * static_cast<double>(free)) {
    out.note = "no unknown cells: what lies outside the walls counts as unknown";
    for (std::size_t i = 0; i < grid.cells().size(); ++i)
      if (outside.data[i] != 0) grid.cells()[i] = Occupancy::Unknown;
  } else {
    out.note = "no unknown cells, and the walls enclose little: all that is free counts as seen";
  }
  out.grid = std::move(grid);
  return out;
}

}  // namespace rubble::scoring
