#pragma once

#include <opencv2/core.hpp>

namespace rubble::scoring {

/// Sets to unknown what an image editor filled in when it turned the map: a region of one known class that reaches a
/// corner of the image, is broad, and borders on nothing but unknown. `classes`: CV_8U of Occupancy values.
void clear_canvas_corners(cv::Mat& classes);

/// The same of a grey picture (CV_8U) before its greys are understood, 255 where it was filled in: a broad region of
/// one grey that reaches a corner and borders on nothing but one other grey, which covers an area itself. What is left
/// is convex.
cv::Mat canvas_corners(const cv::Mat& grey);

/// The most frequent grey (CV_8U) of the pixels that `of` marks (non-zero).
int main_grey(const cv::Mat& grey, const cv::Mat& of);

}  // namespace rubble::scoring
