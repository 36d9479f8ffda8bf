#include <opencv2/imgcodecs.hpp>

#include "scoring/maps/image_codecs.h"

namespace {

cv::Mat read_image(const std::string& path, int flags) { return cv::imread(path, flags); }

}  // namespace

extern "C" __attribute__((visibility("default"))) const rubble::scoring::ImageCodecs* rubble_image_codecs() {
  static const rubble::scoring::ImageCodecs module = {read_image};
  return &module;
}
