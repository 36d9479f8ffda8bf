#pragma once

#include <cstddef>
#include <opencv2/core.hpp>
#include <vector>

namespace rubble::scoring {

/// SURF points of a CV_8U image, strongest first; `descriptors`: CV_32F, 64 columns. A file of its own, because dlib's
/// headers take long to compile.
std::vector<cv::KeyPoint> surf_points(const cv::Mat& image, std::size_t max_points, cv::Mat& descriptors);

}  // namespace rubble::scoring
