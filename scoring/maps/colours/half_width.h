#pragma once

#include <opencv2/core.hpp>

namespace rubble::scoring {

/// How thick what a mask (CV_8U) shows is: the mean distance of its pixels to its rim [pixels]. The picture's border
/// is no rim.
double mean_half_width(const cv::Mat& mask);

}  // namespace rubble::scoring
