#pragma once

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/grid.h"
#include "base/image/geotiff.h"

/// Maps drawn as teams hand them in. Row 0 is at the top.
namespace rubble::scoring::testing {

/// The grid in three grey levels.
inline cv::Mat grey_image(const OccupancyGrid& grid, int wall, int unknown, int free) {
  cv::Mat image(grid.height(), grid.width(), CV_8U);
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) {
      const Occupancy o = grid[{x, grid.height() - 1 - y}];
      image.at<unsigned char>(y, x) = static_cast<unsigned char>(o == Occupancy::Occupied ? wall
                                                                 : o == Occupancy::Free   ? free
                                                                                          : unknown);
    }
  return image;
}

/// The grid as a league map (BGR): checkerboard, walls, and all the drawings a team puts on it.
inline cv::Mat league_image(const OccupancyGrid& grid, bool with_drawings) {
  cv::Mat image(grid.height(), grid.width(), CV_8UC3);
  const int metre = static_cast<int>(std::lround(1.0 / grid.resolution()));
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) {
      const Occupancy o = grid[{x, grid.height() - 1 - y}];
      cv::Vec3b& p = image.at<cv::Vec3b>(y, x);
      if (o == Occupancy::Occupied) p = {120, 40, 0};
      if (o == Occupancy::Free)
        p = (x % (metre / 2) == 0 || y % (metre / 2) == 0) ? cv::Vec3b(191, 190, 190) : cv::Vec3b(255, 255, 255);
      if (o == Occupancy::Unknown)
        p = ((x / metre + y / metre) % 2 != 0) ? cv::Vec3b(238, 237, 237) : cv::Vec3b(227, 226, 226);
    }
  if (!with_drawings) return image;
  const int w = image.cols;
  const int h = image.rows;
  cv::line(image, {w / 2, h / 2}, {w / 2 + 15, h / 2 + 10}, {140, 0, 120}, 1);
  cv::circle(image, {w / 2 + 6, h / 2 - 6}, 4, {10, 10, 240}, cv::FILLED);
  cv::circle(image, {w / 2 - 30, h / 2 + 4}, 4, {240, 10, 10}, cv::FILLED);
  cv::rectangle(image, {w / 2 + 30, h / 2}, {w / 2 + 35, h / 2 + 5}, {30, 100, 255}, cv::FILLED);
  cv::arrowedLine(image, {w / 2 - 8, h / 2 + 8}, {w / 2 - 8, h / 2 + 2}, {0, 200, 255}, 2);
  cv::line(image, {4, 6}, {4 + metre, 6}, {140, 50, 0}, 2);
  cv::putText(image, "map", {30, 8}, cv::FONT_HERSHEY_PLAIN, 0.6, {207, 44, 0}, 1);
  return image;
}

/// The same with so much of its floor, from the west on, searched for victims.
inline cv::Mat with_searched_floor(const cv::Mat& league, double share = 0.5) {
  cv::Mat out = league.clone();
  const cv::Vec3b floor(255, 255, 255);
  for (int y = 0; y < out.rows; ++y)
    for (int x = 0; x < static_cast<int>(share * out.cols); ++x)
      if (out.at<cv::Vec3b>(y, x) == floor) out.at<cv::Vec3b>(y, x) = {130, 230, 130};
  return out;
}

inline RgbImage to_rgb(const cv::Mat& bgr) {
  RgbImage out(bgr.cols, bgr.rows);
  cv::Mat view(bgr.rows, bgr.cols, CV_8UC3, out.rgb.data());
  cv::cvtColor(bgr, view, cv::COLOR_BGR2RGB);
  return out;
}

/// An image turned about its middle [deg, counter-clockwise], on a canvas that holds all of it.
struct TurnedImage {
  cv::Mat image;
  cv::Mat turn;  ///< 2 x 3: pixel of the source -> pixel of `image`
};

inline TurnedImage turned(const cv::Mat& image, double degrees, int interpolation, const cv::Scalar& canvas,
                          double scale = 1.0) {
  TurnedImage out;
  const int side = static_cast<int>(1.5 * scale * std::max(image.cols, image.rows));
  out.turn = cv::getRotationMatrix2D(cv::Point2d(0.5 * image.cols, 0.5 * image.rows), degrees, scale);
  out.turn.at<double>(0, 2) += 0.5 * (side - image.cols);
  out.turn.at<double>(1, 2) += 0.5 * (side - image.rows);
  cv::warpAffine(image, out.image, out.turn, {side, side}, interpolation, cv::BORDER_CONSTANT, canvas);
  return out;
}

/// Drawn with two pixels a cell.
inline cv::Mat fine_league_image(const OccupancyGrid& grid, double searched, bool with_drawings = true) {
  cv::Mat out;
  cv::resize(league_image(grid, with_drawings), out, {}, 2.0, 2.0, cv::INTER_NEAREST);
  return with_searched_floor(out, searched);
}

/// Saved and read again.
inline cv::Mat as_jpeg(const cv::Mat& picture, int quality) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  return cv::imdecode(bytes, cv::IMREAD_COLOR);
}

/// Share of `some` with nothing of `others` beside it.
inline double apart(const cv::Mat& some, const cv::Mat& others) {
  cv::Mat near;
  cv::dilate(others, near, cv::Mat::ones(3, 3, CV_8U));
  return cv::countNonZero(some & ~near) / std::max(1.0, static_cast<double>(cv::countNonZero(some)));
}

}  // namespace rubble::scoring::testing
