#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace rubble::scoring {

/// Outline of the floor or of an obstacle in it: neighbouring cells of the floor, in order, closed.
using WallContour = std::vector<cv::Point>;

std::vector<WallContour> wall_contours(const cv::Mat& floor);

/// A point of a contour where the wall juts into the floor: its end, or an outer corner.
struct WallCorner {
  std::size_t contour = 0;
  std::size_t index = 0;
  cv::Point at;
};

/// Corners that turn by `least_turn` [rad] or more over `scale` cells on both sides; the sharpest of each
/// neighbourhood.
std::vector<WallCorner> wall_corners(const std::vector<WallContour>& contours, int scale, double least_turn);

/// std::lround for what fits an int, without a call: rays ask for the nearest cell at each of their steps.
inline int nearest_whole(double value) {
  const int towards_zero = static_cast<int>(value);
  const double rest = value - towards_zero;
  return towards_zero + (rest >= 0.5 ? 1 : 0) - (rest <= -0.5 ? 1 : 0);
}

/// How far one sees from `origin` in the direction (dx, dy) over non-zero cells, at most `reach` [cells].
double sight(const cv::Mat& floor, const cv::Point2d& origin, double dx, double dy, double reach);

/// The straight line between two cells crosses only floor, but for `skip` cells at its ends.
bool sees(const cv::Mat& floor, const cv::Point& a, const cv::Point& b, double skip);

}  // namespace rubble::scoring
