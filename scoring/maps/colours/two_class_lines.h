#pragma once

#include <opencv2/core.hpp>

namespace rubble::scoring {

/// Lines of one class: where it is crossed along a row or column in 16 pixels or less, with the other on both sides.
struct ClassLines {
  int crossed = 0;  ///< times
  int width = 0;    ///< median of them [pixels]
};

/// `some`, `others`: CV_8U, 255 where a pixel is of that class. What is of neither ends a line.
ClassLines lines_of(const cv::Mat& some, const cv::Mat& others);

}  // namespace rubble::scoring
