#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "base/image/geotiff.h"

namespace rubble::scoring {

/// Occupancy values of an image, CV_8U, row 0 at the top.
struct LabelImage {
  cv::Mat classes;
  std::string recognised;
};

/// 255 where the image is more transparent than not.
cv::Mat transparent_pixels(const RgbImage& image);

/// Walls dark, free light, unknown the most frequent grey between; without such a grey everything light is free.
/// Transparent pixels have no say in what the levels are.
LabelImage classify_grey(const RgbImage& image);

}  // namespace rubble::scoring
