#include "scoring/raster_image.h"

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/error.h"

namespace rubble::scoring {

void check_image_size(const std::string& path, std::int64_t width, std::int64_t height) {
  if (width < 1 || height < 1) throw InputError(path + ": the image is empty");
  if (width > kMaxImageSide || height > kMaxImageSide || width * height > kMaxImageArea)
    throw InputError(path + ": " + std::to_string(width) + " x " + std::to_string(height) +
                     " pixels is too large for a map; scale it down to at most 10000 x 10000");
}

cv::Mat read_raster(const std::string& path) {
  if (!std::ifstream(path)) throw InputError(path + ": cannot be opened; does the file exist?");
  cv::Mat image;
  try {
    image = cv::imread(path, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    throw InputError(path + ": the image cannot be decoded; is it complete, and at most 10000 x 10000 pixels?");
  }
  if (image.empty()) throw InputError(path + ": not an image that can be read (PNG, PGM, BMP, JPEG), or cut short");
  check_image_size(path, image.cols, image.rows);
  if (image.depth() == CV_16U)
    image.convertTo(image, CV_8U, 1.0 / 257.0);
  else if (image.depth() != CV_8U)
    throw InputError(path + ": pixels must have 8 or 16 bit a channel; convert the image");
  return image;
}

RgbImage read_rgb(const std::string& path) {
  const cv::Mat image = read_raster(path);
  RgbImage out(image.cols, image.rows);
  cv::Mat view(image.rows, image.cols, CV_8UC3, out.rgb.data());
  const int channels = image.channels();
  if (channels == 1)
    cv::cvtColor(image, view, cv::COLOR_GRAY2RGB);
  else if (channels == 3)
    cv::cvtColor(image, view, cv::COLOR_BGR2RGB);
  else if (channels == 4)
    cv::cvtColor(image, view, cv::COLOR_BGRA2RGB);
  else
    throw InputError(path + ": " + std::to_string(channels) + " channels; convert the image to grey or RGB");
  return out;
}

}  // namespace rubble::scoring
