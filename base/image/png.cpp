#include "base/image/png.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "base/error.h"
#include "base/text/text_file.h"

namespace rubble {
namespace {

constexpr int kCompression = 3;  // of 9: map-like pictures hardly shrink further

cv::Mat bgr_of(const RgbImage& image) {
  cv::Mat bgr;
  const cv::Mat rgb(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb.data()));
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  return bgr;
}

}  // namespace

std::string png_bytes(const cv::Mat& bgr) {
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", bgr, bytes, {cv::IMWRITE_PNG_COMPRESSION, kCompression}))
    throw RunError("a picture cannot be packed as PNG");
  return {bytes.begin(), bytes.end()};
}

std::string png_bytes(const RgbImage& image) { return png_bytes(bgr_of(image)); }

void write_png(const std::string& path, const cv::Mat& bgr) { write_text_file(path, png_bytes(bgr)); }

void write_png(const std::string& path, const RgbImage& image) { write_png(path, bgr_of(image)); }

}  // namespace rubble
