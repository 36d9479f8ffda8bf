#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "base/image/geotiff.h"

namespace rubble::scoring {

/// What a reader says of walls that ran into what is beside them.
inline constexpr const char* kWallsPale =
    ", walls pale as in a picture that was blurred or made smaller: thin ones may be lost";

/// Difference of the channels up to which a pixel, or the middle of an area, is a grey and no colour. RViz draws
/// unknown ground in 112,137,134, which has 25; JPEG of qualities 35 to 100 leaves up to 36 in 99.9 % of its pixels.
inline constexpr int kMostTint = 36;

/// Occupancy values of an image, CV_8U, row 0 at the top.
struct LabelImage {
  cv::Mat classes;
  std::string recognised;
  std::string refusal{};  ///< why the image is no map; empty: it is one
  std::string doubt{};    ///< of what was recognised (reading_doubts.h); empty: none
  bool by_level = false;  ///< each of its colours was taken for one class
};

/// 255 where the image is more transparent than not.
cv::Mat transparent_pixels(const RgbImage& image);

/// Brightness, CV_8U.
cv::Mat grey_of(const RgbImage& image);

/// The values that occur in it (CV_8U), the darkest first.
std::vector<int> greys_there(const cv::Mat& grey);

/// By what the greys (CV_8U) stand for (grey_roles()). Pixels `apart` (CV_8U, 255) have no say in that; those of the
/// `canvas` are among them.
LabelImage classify_grey(const cv::Mat& grey, const cv::Mat& apart, const cv::Mat& canvas);

}  // namespace rubble::scoring
