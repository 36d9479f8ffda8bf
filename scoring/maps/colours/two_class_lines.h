#pragma once

#include <opencv2/core.hpp>

namespace rubble::scoring {

constexpr int kWidestLine = 16;    ///< line that has two sides [pixels]
constexpr int kLeastLines = 20;    ///< so often crossed: fewer say nothing
constexpr double kThinLine = 0.6;  ///< of the ground's mean distance to its rim, that lines have at the most

/// Lines of one class: where it is crossed along a row or column in 16 pixels or less, with the other on both sides.
struct ClassLines {
  int crossed = 0;  ///< times
  int width = 0;    ///< median of them [pixels]
};

/// `some`, `others`: CV_8U, 255 where a pixel is of that class. What is of neither ends a line.
ClassLines lines_of(const cv::Mat& some, const cv::Mat& others);

/// The class covers 2 % of the picture and more in areas into which a square of so many pixels fits, those at the rim
/// as if they went on if `goes_on`.
bool covers_ground(const cv::Mat& some, int side, bool goes_on);

}  // namespace rubble::scoring
