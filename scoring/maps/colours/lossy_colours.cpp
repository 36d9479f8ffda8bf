#include "scoring/maps/colours/lossy_colours.h"

#include <algorithm>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace rubble::scoring {
namespace {

/// The pieces of `weak` that have a pixel of `sure` in them.
cv::Mat grown_from(const cv::Mat& sure, const cv::Mat& weak) {
  cv::Mat labels;
  const int count = cv::connectedComponents(weak, labels, 8, CV_32S);
  std::vector<bool> holds(static_cast<std::size_t>(count), false);
  for (int y = 0; y < weak.rows; ++y)
    for (int x = 0; x < weak.cols; ++x)
      if (sure.at<unsigned char>(y, x) != 0) holds[static_cast<std::size_t>(labels.at<int>(y, x))] = true;
  cv::Mat out = weak.clone();
  for (int y = 0; y < weak.rows; ++y)
    for (int x = 0; x < weak.cols; ++x)
      if (!holds[static_cast<std::size_t>(labels.at<int>(y, x))]) out.at<unsigned char>(y, x) = 0;
  return out;
}

constexpr float kWhite = 255.0F;
constexpr float kWallBrightness = 37.0F;  // of 0,40,120
constexpr float kMostBlue = 80.0F;        // Cb of walls, whose own is 47; of QR codes 115
constexpr double kWide = 2.5;             // sigma of the wider smear [pixels]
constexpr int kReach = 12;                // beyond it a smear is cut off [pixels]: 4 sigma and one
constexpr int kBand = 512;                // rows that are worked on at a time: ten floats a pixel

struct Tinted {
  cv::Mat ink;   ///< CV_32F, 1: as dark as a wall, 0: white
  cv::Mat blue;  ///< CV_32F, Cb: 47 in a wall, 50 in the path, -39 in a victim
  cv::Mat red;   ///< CV_32F, Cr: -26 in a wall, 48 in the path, 115 in a victim
};

/// Of these rows.
Tinted tints(const RgbImage& image, const cv::Range& rows) {
  Tinted out;
  for (cv::Mat* m : {&out.ink, &out.blue, &out.red}) *m = cv::Mat(rows.size(), image.width, CV_32F);
  for (int y = 0; y < rows.size(); ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.pixel(x, rows.start + y);
      const float brightness = 0.299F * p[0] + 0.587F * p[1] + 0.114F * p[2];
      out.ink.at<float>(y, x) = (kWhite - brightness) / (kWhite - kWallBrightness);
      out.blue.at<float>(y, x) = 0.564F * (p[2] - brightness);
      out.red.at<float>(y, x) = 0.713F * (p[0] - brightness);
    }
  return out;
}

/// The colours around each pixel (Gaussian, `sigma` pixels), summed and divided by the ink that they belong to.
Tinted around(const Tinted& t, double sigma) {
  constexpr float kDark = 0.35F;  // ink that counts
  cv::Mat ink = t.ink.clone();
  ink.setTo(0.0F, t.ink < kDark);
  Tinted out;
  cv::GaussianBlur(ink, out.ink, {}, sigma);
  out.ink = cv::max(out.ink, 1e-6F);
  cv::GaussianBlur(t.blue, out.blue, {}, sigma);
  cv::GaussianBlur(t.red, out.red, {}, sigma);
  out.blue /= out.ink;
  out.red /= out.ink;
  return out;
}

/// What is as dark and blue as a wall in these rows: perhaps (`weak`) and without doubt.
void dark_in(const RgbImage& image, const cv::Range& band, cv::Mat& weak, cv::Mat& sure) {
  constexpr float kSure = 0.62F;
  constexpr float kWall = 0.48F;
  const cv::Range rows(std::max(0, band.start - kReach), std::min(image.height, band.end + kReach));
  const Tinted t = tints(image, rows);
  // Between symbols the colour near by is the wall's own, in the open the one around.
  const Tinted near = around(t, 1.0);
  const Tinted wide = around(t, kWide);
  for (int y = 0; y < weak.rows; ++y) {
    const int at = band.start - rows.start + y;
    for (int x = 0; x < weak.cols; ++x) {
      const float a = t.ink.at<float>(at, x);
      const auto is = [&](const Tinted& c, float least_blue, float most_red) {
        const float blue = c.blue.at<float>(at, x);
        return blue > least_blue && blue < kMostBlue && c.red.at<float>(at, x) < most_red;
      };
      weak.at<unsigned char>(y, x) = a >= kWall && (is(wide, 12.0F, 12.0F) || is(near, 12.0F, 6.0F)) ? 255 : 0;
      sure.at<unsigned char>(y, x) = a >= kSure && is(wide, 20.0F, 2.0F) ? 255 : 0;
    }
  }
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
  return 20 * faint > 21 * strong;
}

cv::Mat walls_by_brightness(const RgbImage& image) {
  cv::Mat weak(image.height, image.width, CV_8U);
  cv::Mat sure(image.height, image.width, CV_8U);
  for (int from = 0; from < image.height; from += kBand) {
    const cv::Range band(from, std::min(image.height, from + kBand));
    cv::Mat weak_here = weak.rowRange(band), sure_here = sure.rowRange(band);
    dark_in(image, band, weak_here, sure_here);
  }
  return grown_from(sure & weak, weak);
}

cv::Mat unexplored_by_brightness(const RgbImage& image) {
  constexpr int kEven = 7;       // [pixels]
  constexpr float kWay = 12.0F;  // Cb and Cr of what may be the way, whose own are 50 and 48
  cv::Mat brightness(image.height, image.width, CV_8U);
  cv::Mat by_the_way(image.height, image.width, CV_8U);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      const float light = 0.299F * p[0] + 0.587F * p[1] + 0.114F * p[2];
      const bool may_be_way = 0.564F * (p[2] - light) > kWay && 0.713F * (p[0] - light) > kWay;
      by_the_way.at<unsigned char>(y, x) = may_be_way ? 255 : 0;
      brightness.at<unsigned char>(y, x) =
          static_cast<unsigned char>((299 * p[0] + 587 * p[1] + 114 * p[2] + 500) / 1000);
    }
  // Where the way of the robot meets the grid, both blur to the same shade; ground has it evenly somewhere, or away
  // from the way.
  cv::dilate(by_the_way, by_the_way, cv::Mat::ones(kEven, kEven, CV_8U));
  cv::Mat darkest, lightest;
  cv::erode(brightness, darkest, cv::Mat::ones(kEven, kEven, CV_8U));
  cv::dilate(brightness, lightest, cv::Mat::ones(kEven, kEven, CV_8U));
  // The grid of explored ground, lines of a pixel or two, is no shade of it.
  cv::morphologyEx(brightness, brightness, cv::MORPH_CLOSE, cv::Mat::ones(3, 3, CV_8U));
  cv::Mat middle;
  cv::medianBlur(brightness, middle, 5);
  const cv::Mat weak = (middle >= 220) & (middle <= 246);
  const cv::Mat even = (darkest >= 212) & (lightest <= 248);
  return grown_from(weak & (even | ~by_the_way), weak);
}

}  // namespace rubble::scoring
