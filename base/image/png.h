#pragma once

#include <string>

#include "base/image/geotiff.h"

namespace cv {
class Mat;
}

namespace rubble {

/// A picture as the bytes of a PNG file, the same on every run. `bgr`: 8 bits, blue first, as OpenCV keeps it.
std::string png_bytes(const cv::Mat& bgr);
std::string png_bytes(const RgbImage& image);

/// Writes the file. Throws RunError.
void write_png(const std::string& path, const cv::Mat& bgr);
void write_png(const std::string& path, const RgbImage& image);

}  // namespace rubble
