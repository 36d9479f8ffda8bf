#include "scoring/maps/grey_levels.h"

#include <algorithm>
#include <array>
#include <functional>
#include <opencv2/imgproc.hpp>

#include "base/grid.h"

namespace rubble::scoring {
namespace {

constexpr int kDarkest = 90;  // an unknown grey is between these
constexpr int kLightest = 245;
constexpr int kTolerance = 12;          // around the unknown grey
constexpr double kUnknownShare = 0.01;  // of all pixels, to be a level and not the fringe of the walls
constexpr int kWallBelow = 140;         // mixtures of black and white: at least 45 % wall
constexpr double kPureShare = 0.999;    // pixels on the three main levels of a map that was never interpolated

cv::Mat grey_of(const RgbImage& image) {
  cv::Mat grey(image.height, image.width, CV_8U);
  for (int y = 0; y < image.height; ++y) {
    unsigned char* row = grey.ptr<unsigned char>(y);
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      row[x] = static_cast<unsigned char>((299 * p[0] + 587 * p[1] + 114 * p[2] + 500) / 1000);
    }
  }
  return grey;
}

using Histogram = std::array<std::size_t, 256>;

Histogram histogram(const cv::Mat& grey, const cv::Mat& transparent) {
  Histogram count{};
  for (int y = 0; y < grey.rows; ++y)
    for (int x = 0; x < grey.cols; ++x)
      if (transparent.at<unsigned char>(y, x) == 0) ++count[grey.at<unsigned char>(y, x)];
  return count;
}

/// The most frequent grey between dark and light, or -1.
int unknown_level(const Histogram& count, double total) {
  const auto peak = std::max_element(count.begin() + kDarkest, count.begin() + kLightest + 1);
  return static_cast<double>(*peak) >= kUnknownShare * total ? static_cast<int>(peak - count.begin()) : -1;
}

bool is_pure(Histogram count, double total) {
  std::sort(count.begin(), count.end(), std::greater<>());
  return static_cast<double>(count[0] + count[1] + count[2]) >= kPureShare * total;
}

}  // namespace

cv::Mat transparent_pixels(const RgbImage& image) {
  cv::Mat out = cv::Mat::zeros(image.height, image.width, CV_8U);
  if (image.alpha.empty()) return out;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (image.alpha[image.index(x, y)] < 128) out.at<unsigned char>(y, x) = 255;
  return out;
}

LabelImage classify_grey(const RgbImage& image) {
  const cv::Mat grey = grey_of(image);
  const cv::Mat transparent = transparent_pixels(image);
  const Histogram count = histogram(grey, transparent);
  const double total = static_cast<double>(grey.total()) - cv::countNonZero(transparent);
  const int level = unknown_level(count, total);
  LabelImage out;
  out.classes = cv::Mat(grey.size(), CV_8U, cv::Scalar(static_cast<int>(Occupancy::Free)));
  out.classes.setTo(static_cast<int>(Occupancy::Occupied), grey < kWallBelow);
  if (level < 0) {
    out.recognised = "grey levels without unknown";
    return out;
  }
  out.recognised = "grey levels, unknown " + std::to_string(level);
  cv::Mat unknown = (grey >= level - kTolerance) & (grey <= level + kTolerance);
  if (!is_pure(count, total)) {
    // The fringe between a wall and free space passes through the same grey: only an area of it is unknown, and its
    // rim is a mixture with wall or free.
    cv::morphologyEx(unknown, unknown, cv::MORPH_OPEN, cv::Mat::ones(3, 3, CV_8U));
    cv::Mat rim;
    cv::dilate(unknown, rim, cv::Mat::ones(3, 3, CV_8U));
    unknown |= rim & (grey >= 0.55 * level) & (grey <= level + kTolerance);
  }
  out.classes.setTo(static_cast<int>(Occupancy::Unknown), unknown);
  return out;
}

}  // namespace rubble::scoring
