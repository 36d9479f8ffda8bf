#include "scoring/maps/lossy_colours.h"

#include <algorithm>
#include <cstdlib>
#include <opencv2/imgproc.hpp>

namespace rubble::scoring {
namespace {

constexpr float kWhite = 255.0F;
constexpr float kWallBrightness = 37.0F;  // of 0,40,120

struct Tinted {
  cv::Mat ink;   ///< CV_32F, 1: as dark as a wall, 0: white
  cv::Mat blue;  ///< CV_32F, Cb: 47 in a wall, 50 in the path, -39 in a victim
  cv::Mat red;   ///< CV_32F, Cr: -26 in a wall, 48 in the path, 115 in a victim
};

Tinted tints(const RgbImage& image) {
  Tinted out;
  for (cv::Mat* m : {&out.ink, &out.blue, &out.red}) *m = cv::Mat(image.height, image.width, CV_32F);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      const float brightness = 0.299F * p[0] + 0.587F * p[1] + 0.114F * p[2];
      out.ink.at<float>(y, x) = (kWhite - brightness) / (kWhite - kWallBrightness);
      out.blue.at<float>(y, x) = 0.564F * (p[2] - brightness);
      out.red.at<float>(y, x) = 0.713F * (p[0] - brightness);
    }
  return out;
}

}  // namespace

bool has_run_colours(const RgbImage& image) {
  constexpr int kFaint = 3;  // spread of the channels
  constexpr int kStrong = 24;
  std::size_t faint = 0;
  std::size_t strong = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      const auto [low, high] = std::minmax({int{p[0]}, int{p[1]}, int{p[2]}});
      const bool searched = p[1] == high && std::abs(p[0] - p[2]) <= 4;
      if (high - low >= kStrong)
        ++strong;
      else if (high - low >= kFaint && !searched)
        ++faint;
    }
  return 5 * faint > 9 * strong;
}

cv::Mat walls_by_brightness(const RgbImage& image) {
  constexpr double kSmear = 2.5;  // [pixels]
  constexpr float kDark = 0.35F;  // ink that counts
  constexpr float kSure = 0.62F;
  constexpr float kWall = 0.48F;
  const Tinted t = tints(image);
  cv::Mat ink = t.ink.clone();
  ink.setTo(0.0F, t.ink < kDark);
  cv::Mat sum, blue, red;
  cv::GaussianBlur(ink, sum, {}, kSmear);
  cv::GaussianBlur(t.blue, blue, {}, kSmear);
  cv::GaussianBlur(t.red, red, {}, kSmear);
  cv::Mat weak(t.ink.size(), CV_8U);
  cv::Mat sure(t.ink.size(), CV_8U);
  for (int y = 0; y < weak.rows; ++y)
    for (int x = 0; x < weak.cols; ++x) {
      const float a = t.ink.at<float>(y, x);
      const float s = std::max(1e-6F, sum.at<float>(y, x));
      const float cb = blue.at<float>(y, x) / s;
      const float cr = red.at<float>(y, x) / s;
      weak.at<unsigned char>(y, x) = a >= kWall && cb > 12.0F && cr < 12.0F ? 255 : 0;
      sure.at<unsigned char>(y, x) = a >= kSure && cb > 20.0F && cr < 2.0F ? 255 : 0;
    }
  cv::Mat labels;
  const int count = cv::connectedComponents(weak, labels, 8, CV_32S);
  std::vector<int> sures(static_cast<std::size_t>(count), 0);
  for (int y = 0; y < weak.rows; ++y)
    for (int x = 0; x < weak.cols; ++x)
      if (sure.at<unsigned char>(y, x) != 0) ++sures[static_cast<std::size_t>(labels.at<int>(y, x))];
  for (int y = 0; y < weak.rows; ++y)
    for (int x = 0; x < weak.cols; ++x)
      if (sures[static_cast<std::size_t>(labels.at<int>(y, x))] == 0) weak.at<unsigned char>(y, x) = 0;
  return weak;
}

cv::Mat unexplored_by_brightness(const RgbImage& image) {
  cv::Mat brightness(image.height, image.width, CV_8U);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      brightness.at<unsigned char>(y, x) =
          static_cast<unsigned char>((299 * p[0] + 587 * p[1] + 114 * p[2] + 500) / 1000);
    }
  cv::Mat middle;
  cv::medianBlur(brightness, middle, 5);
  return (middle >= 220) & (middle <= 243);
}

}  // namespace rubble::scoring
