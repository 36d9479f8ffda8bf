#include "scoring/maps/colours/blur.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace rubble::scoring {
namespace {

/// CV_32F.
cv::Mat channel_of(const RgbImage& image, int channel) {
  cv::Mat out(image.height, image.width, CV_32F);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) out.at<float>(y, x) = image.pixel(x, y)[channel];
  return out;
}

/// One channel of a picture as frequencies.
class Spectrum {
 public:
  Spectrum(const cv::Mat& channel, bool ripples) : size_(channel.size()), noise_(ripples ? kRipples : kRounding) {
    const int rows = cv::getOptimalDFTSize(size_.height + 2 * kMargin);
    const int columns = cv::getOptimalDFTSize(size_.width + 2 * kMargin);
    cv::Mat plane;
    cv::copyMakeBorder(channel, plane, kMargin, rows - size_.height - kMargin, kMargin, columns - size_.width - kMargin,
                       cv::BORDER_REPLICATE);
    cv::dft(plane, frequencies_, cv::DFT_COMPLEX_OUTPUT);
  }

  /// The channel without a blur of `sigma`, CV_32F.
  cv::Mat sharpened(double sigma) const {
    constexpr double kRemaining = 0.6;  // what edges keep of it: sharper ones would ring [pixels]
    const std::vector<double> across = gaussian(frequencies_.cols, sigma), down = gaussian(frequencies_.rows, sigma);
    const std::vector<double> left_across = gaussian(frequencies_.cols, kRemaining);
    const std::vector<double> left_down = gaussian(frequencies_.rows, kRemaining);
    cv::Mat out = frequencies_.clone();
    for (int y = 0; y < out.rows; ++y)
      for (int x = 0; x < out.cols; ++x) {
        const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y);
        const double blur = across[i] * down[j];
        const double wiener = blur * (1.0 + noise_) / (blur * blur + noise_);
        out.at<cv::Vec2f>(y, x) *= static_cast<float>(left_across[i] * left_down[j] * wiener);
      }
    cv::Mat plane;
    cv::dft(out, plane, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
    return plane(cv::Rect({kMargin, kMargin}, size_));
  }

 private:
  static constexpr int kMargin = 32;                          // [pixels]
  static constexpr double kRounding = 1e-3, kRipples = 5e-3;  // their power to that of lines

  /// What a blur leaves of each frequency along one axis.
  static std::vector<double> gaussian(int count, double sigma) {
    std::vector<double> out;
    for (int k = 0; k < count; ++k) {
      const double w = 2.0 * CV_PI * std::min(k, count - k) / count * sigma;
      out.push_back(std::exp(-0.5 * w * w));
    }
    return out;
  }

  cv::Size size_;
  double noise_;
  cv::Mat frequencies_;
};

constexpr int kGreen = 1;  // in which every line and drawing is darker than the ground

/// From pixel to pixel along a row, in green.
struct Steps {
  double all = 0.0;            ///< sum of their sizes
  std::size_t steep = 0;       ///< as no blurred edge is
  std::size_t in_a_row = 0;    ///< two, neither of them 0
  std::size_t to_and_fro = 0;  ///< three small ones, up, down, up or the other way: no blurred line has such
};

Steps steps_of(const RgbImage& image) {
  constexpr int kSteep = 96;  // an edge from 0 to 231 blurred by one pixel has 92
  constexpr int kSmall = 8;
  Steps out;
  for (int y = 0; y < image.height; ++y) {
    int last = 0, before = 0;
    for (int x = 1; x < image.width; ++x) {
      const int step = image.pixel(x, y)[kGreen] - image.pixel(x - 1, y)[kGreen];
      out.all += std::abs(step);
      out.steep += std::abs(step) > kSteep ? 1 : 0;
      out.in_a_row += step != 0 && last != 0 ? 1 : 0;
      const bool small = std::max({std::abs(step), std::abs(last), std::abs(before)}) <= kSmall;
      out.to_and_fro += small && step * last < 0 && last * before < 0 ? 1 : 0;
      before = last;
      last = step;
    }
  }
  return out;
}

/// How far a sharpened picture is lighter than the lightest of the blurred one around: rims beside lines that were
/// sharpened by more than they had been blurred, since on a map lines are darker than ground.
double overshoot(const cv::Mat& plane, const cv::Mat& lightest) {
  constexpr float kSlack = 5.0F;  // rounding
  double out = 0.0;
  for (int y = 0; y < plane.rows; ++y)
    for (int x = 0; x < plane.cols; ++x)
      out += std::max(0.0F, plane.at<float>(y, x) - lightest.at<float>(y, x) - kSlack);
  return out;
}

}  // namespace

Blur blur_of(const RgbImage& image) {
  constexpr double kLeast = 1.0, kLeastRippled = 1.2, kFineness = 0.05;  // [pixels]
  constexpr double kMostOvershoot = 0.05;  // of the steps: 0.02 to 0.2 at the right size, 0.4 a fifth of a pixel beyond
  constexpr int kAround = 31;              // [pixels]
  constexpr double kRippled = 0.01;  // of steps in a row: up to 0.0014 of blurred lines, 0.025 and more through JPEG
  constexpr std::size_t kOneIn = 5000, kMostPixels = 16'000'000;
  const std::size_t pixels = image.rgb.size() / 3;
  if (pixels > kMostPixels) return {};
  const Steps steps = steps_of(image);
  if (kOneIn * steps.steep > pixels || steps.all == 0.0) return {};
  Blur out;
  out.ripples = static_cast<double>(steps.to_and_fro) > kRippled * static_cast<double>(steps.in_a_row);
  const cv::Mat plane = channel_of(image, kGreen);
  const Spectrum spectrum(plane, out.ripples);
  cv::Mat lightest;
  cv::dilate(plane, lightest, cv::Mat::ones(kAround, kAround, CV_8U));
  const auto may_be = [&](double sigma) {
    return overshoot(spectrum.sharpened(sigma), lightest) <= kMostOvershoot * steps.all;
  };
  double low = out.ripples ? kLeastRippled : kLeast, high = Blur::kMost;
  if (!may_be(low)) return {};
  while (high - low > kFineness) {
    const double middle = 0.5 * (low + high);
    (may_be(middle) ? low : high) = middle;
  }
  out.sigma = low;
  return out;
}

RgbImage without_blur(const RgbImage& image, const Blur& blur) {
  RgbImage out = image;
  for (int channel = 0; channel < 3; ++channel) {
    const cv::Mat plane = Spectrum(channel_of(image, channel), blur.ripples).sharpened(blur.sigma);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        out.pixel(x, y)[channel] = cv::saturate_cast<std::uint8_t>(plane.at<float>(y, x));
  }
  return out;
}

}  // namespace rubble::scoring
