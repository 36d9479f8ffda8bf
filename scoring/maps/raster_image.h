#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "base/image/geotiff.h"

namespace rubble::scoring {

constexpr int kMaxImageSide = 20000;               ///< [pixels]
constexpr std::int64_t kMaxImageArea = 100000000;  ///< [pixels]
constexpr double kFarthestPlace = 1e8;  ///< of a map from the origin of its coordinates, [m]: Earth is 4e7 m around

/// What to do where a picture says how to turn it (EXIF).
enum class Upright { AsSeen, AsStored };

/// Any PNG, JPEG, BMP or PNM (1, 3 or 4 channels of 8 bit; deeper ones are scaled by the range they use).
/// Throws InputError: missing, not such an image (others are named), too large.
cv::Mat read_raster(const std::string& path, Upright upright = Upright::AsStored);

/// The same as RGB; transparent pixels show the league's grey of unexplored ground.
RgbImage read_rgb(const std::string& path, Upright upright = Upright::AsSeen);

/// Throws InputError when the sides are out of range.
void check_image_size(const std::string& path, std::int64_t width, std::int64_t height);

}  // namespace rubble::scoring
