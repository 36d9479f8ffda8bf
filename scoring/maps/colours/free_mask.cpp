#include "scoring/maps/colours/free_mask.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <opencv2/imgproc.hpp>

#include "scoring/maps/colours/canvas_corners.h"
#include "scoring/maps/colours/half_width.h"
#include "scoring/maps/colours/two_class_lines.h"

namespace rubble::scoring {
namespace {

constexpr double kOfRim = 0.5;           // of the picture's rim that the rest has
constexpr int kLeastSquare = 9;          // of ground that was never seen [pixels]
constexpr double kEnclosedByPlan = 0.2;  // of the free ground, that walls of a drawing enclose
constexpr int kMaskSlit = 5;             // in these [pixels]

struct TwoLevels {
  int dark = 0, light = 0;
};

/// Nothing where it has more greys, or fewer: blended edges and a third class look alike.
std::optional<TwoLevels> two_levels(const cv::Mat& grey, const cv::Mat& apart) {
  std::array<bool, 256> there{};
  for (int y = 0; y < grey.rows; ++y)
    for (int x = 0; x < grey.cols; ++x)
      if (apart.at<unsigned char>(y, x) == 0) there[grey.at<unsigned char>(y, x)] = true;
  if (std::count(there.begin(), there.end(), true) != 2) return std::nullopt;
  const auto dark = std::find(there.begin(), there.end(), true);
  return TwoLevels{static_cast<int>(dark - there.begin()),
                   static_cast<int>(std::find(dark + 1, there.end(), true) - there.begin())};
}

double share_of_rim(const cv::Mat& mask, const cv::Mat& apart) {
  double here = 0.0, all = 0.0;
  const auto ask = [&](int x, int y) {
    if (apart.at<unsigned char>(y, x) != 0) return;
    all += 1.0;
    here += mask.at<unsigned char>(y, x) != 0 ? 1.0 : 0.0;
  };
  for (int x = 0; x < mask.cols; ++x) ask(x, 0), ask(x, mask.rows - 1);
  for (int y = 0; y < mask.rows; ++y) ask(0, y), ask(mask.cols - 1, y);
  return all > 0.0 ? here / all : 0.0;
}

/// A drawing of walls on a page, in a canvas of the walls' grey: without the canvas its walls enclose free ground.
bool is_drawing_on_canvas(const cv::Mat& grey, const cv::Mat& rest, const cv::Mat& free) {
  const cv::Mat canvas = canvas_corners(grey);
  if (cv::countNonZero(canvas) == 0) return false;
  cv::Mat open;
  cv::morphologyEx(rest & ~canvas, open, cv::MORPH_CLOSE, cv::Mat::ones(kMaskSlit, kMaskSlit, CV_8U));
  open = ~open | canvas;
  open.at<unsigned char>(0, 0) = 255;
  cv::floodFill(open, {0, 0}, cv::Scalar(128));
  return cv::countNonZero(free & (open != 128)) >= kEnclosedByPlan * cv::countNonZero(free);
}

}  // namespace

std::optional<FreeMask> free_mask(const cv::Mat& grey, const cv::Mat& apart) {
  const std::optional<TwoLevels> levels = two_levels(grey, apart);
  if (!levels) return std::nullopt;
  const int middle = (levels->dark + levels->light) / 2;
  const cv::Mat dark = (grey <= middle) & ~apart, light = (grey > middle) & ~apart;
  const bool is_dark = share_of_rim(dark, apart) >= kOfRim;
  const cv::Mat &rest = is_dark ? dark : light, &free = is_dark ? light : dark;
  const ClassLines walls = lines_of(rest, free), ways = lines_of(free, rest);
  if (walls.crossed < kLeastLines || (2 * ways.crossed >= walls.crossed && ways.width <= walls.width) ||
      0.5 * walls.width > kThinLine * mean_half_width(free) ||
      !covers_ground(rest, std::max(kLeastSquare, 2 * walls.width + 1), true) || is_drawing_on_canvas(grey, rest, free))
    return std::nullopt;
  FreeMask out;
  out.free = free;
  cv::Mat far;
  cv::distanceTransform(~free, far, cv::DIST_L2, 5);
  out.walls = rest & (far <= walls.width + 0.5);
  out.recognised = "a mask, free ground " + std::to_string(is_dark ? levels->light : levels->dark) + ", all else " +
                   std::to_string(is_dark ? levels->dark : levels->light) + ": walls are taken " +
                   std::to_string(walls.width) + " pixel" + (walls.width == 1 ? "" : "s") +
                   " thick, what lies behind them is unknown";
  out.doubt =
      "walls and ground that was never seen have one grey: wherever free ground ends a wall was taken, also where "
      "none stands; if the other grey is free ground, invert the picture";
  return out;
}

}  // namespace rubble::scoring
