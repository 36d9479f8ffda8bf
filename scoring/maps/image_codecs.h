#pragma once

#include <opencv2/core.hpp>
#include <string>

/// OpenCV's readers of PNG, JPEG, BMP, PGM and so on need libopencv-imgcodecs, which loads GDAL and with it eighty
/// other libraries. They lie in the module rubble_image_codecs.so, so that only those who read such a file wait for
/// them: TIFF is read and PNG written without.
namespace rubble::scoring {

/// What the module does.
struct ImageCodecs {
  /// cv::imread() with its flags.
  cv::Mat (*read)(const std::string& path, int flags);
};

/// The border between the program and the module: one function, found by its name.
constexpr const char* kImageCodecsSymbol = "rubble_image_codecs";
using ImageCodecsFunction = const ImageCodecs* (*)();

/// The module, loaded when first asked for. Throws RunError where it cannot be.
const ImageCodecs& image_codecs();

}  // namespace rubble::scoring
