#include "scoring/walls/wall_contours.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/angle.h"

namespace rubble::scoring {
namespace {

/// Angle by which the contour turns around the wall at each of its points; negative: around the floor.
std::vector<double> turns(const WallContour& contour, std::size_t scale) {
  const std::size_t n = contour.size();
  std::vector<double> turn(n);
  for (std::size_t i = 0; i < n; ++i) {
    const cv::Point before = contour[i] - contour[(i + n - scale) % n];
    const cv::Point after = contour[(i + scale) % n] - contour[i];
    turn[i] = std::atan2(static_cast<double>(before.cross(after)), static_cast<double>(before.dot(after)));
    if (std::abs(turn[i]) > 3.0) turn[i] = kPi;  // there and back: only the end of a thin wall does that
  }
  return turn;
}

bool is_sharpest(const std::vector<double>& turn, std::size_t i, std::size_t reach) {
  const std::size_t n = turn.size();
  for (std::size_t j = 1; j <= reach; ++j)
    if (turn[(i + j) % n] > turn[i] || turn[(i + n - j) % n] >= turn[i]) return false;
  return true;
}

bool is_floor(const cv::Mat& floor, int x, int y) {
  return x >= 0 && y >= 0 && x < floor.cols && y < floor.rows && floor.at<unsigned char>(y, x) != 0;
}

}  // namespace

std::vector<WallContour> wall_contours(const cv::Mat& floor) {
  std::vector<WallContour> contours;
  cv::findContours(floor.clone(), contours, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
  return contours;
}

std::vector<WallCorner> wall_corners(const std::vector<WallContour>& contours, int scale, double least_turn) {
  const auto reach = static_cast<std::size_t>(scale);
  std::vector<WallCorner> corners;
  for (std::size_t c = 0; c < contours.size(); ++c) {
    if (contours[c].size() < 2 * reach + 1) continue;
    const std::vector<double> turn = turns(contours[c], reach);
    for (std::size_t i = 0; i < turn.size(); ++i)
      if (turn[i] >= least_turn && is_sharpest(turn, i, reach / 2)) corners.push_back({c, i, contours[c][i]});
  }
  return corners;
}

double sight(const cv::Mat& floor, const cv::Point2d& origin, double dx, double dy, double reach) {
  const auto inside = [&](double x, double y) {
    return x >= 0.0 && y >= 0.0 && x < floor.cols - 1 && y < floor.rows - 1;
  };
  // A ray that begins and ends inside is inside all along: its cells need no looking whether they are.
  if (inside(origin.x, origin.y) && inside(origin.x + reach * dx, origin.y + reach * dy)) {
    for (double t = 0.0; t < reach; t += 1.0)
      if (floor.ptr(nearest_whole(origin.y + t * dy))[nearest_whole(origin.x + t * dx)] == 0) return t;
    return reach;
  }
  for (double t = 0.0; t < reach; t += 1.0)
    if (!is_floor(floor, nearest_whole(origin.x + t * dx), nearest_whole(origin.y + t * dy))) return t;
  return reach;
}

bool sees(const cv::Mat& floor, const cv::Point& a, const cv::Point& b, double skip) {
  constexpr double kStepsPerCell = 1.5;
  const cv::Point2d along = cv::Point2d(b) - cv::Point2d(a);
  const double length = std::hypot(along.x, along.y);
  const int steps = std::max(1, static_cast<int>(std::ceil(length * kStepsPerCell)));
  for (int i = 0; i <= steps; ++i) {
    const double u = static_cast<double>(i) / steps;
    if (u * length < skip || (1.0 - u) * length < skip) continue;
    if (!is_floor(floor, nearest_whole(a.x + along.x * u), nearest_whole(a.y + along.y * u))) return false;
  }
  return true;
}

}  // namespace rubble::scoring
