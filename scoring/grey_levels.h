#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "base/geotiff.h"

namespace rubble::scoring {

/// Occupancy values of an image, CV_8U, row 0 at the top.
struct LabelImage {
  cv::Mat classes;
  std::string recognised;
};

/// Walls dark, free light, unknown the most frequent grey between; without such a grey everything light is free.
LabelImage classify_grey(const RgbImage& image);

}  // namespace rubble::scoring
