#include "scoring/maps/colours/even_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "scoring/maps/colours/map_colours.h"
#include "tests/support/map_pictures.h"
#include "tests/support/scoring_grounds.h"
#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;

/// Darker towards the corners, by this share there.
cv::Mat with_vignette(const cv::Mat& image, double share) {
  cv::Mat out = image.clone();
  const double r2 = 0.25 * (image.rows * image.rows + image.cols * image.cols);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) {
      const double dx = x - 0.5 * image.cols, dy = y - 0.5 * image.rows;
      out.at<unsigned char>(y, x) =
          cv::saturate_cast<unsigned char>(image.at<unsigned char>(y, x) * (1.0 - share * (dx * dx + dy * dy) / r2));
    }
  return out;
}

cv::Mat classes_of(const cv::Mat& grey) {
  cv::Mat bgr;
  cv::cvtColor(grey, bgr, cv::COLOR_GRAY2BGR);
  const ClassImage read = classify(to_rgb(bgr), {});
  EXPECT_EQ(read.refusal, "");
  cv::Mat out(grey.size(), CV_8U);
  for (int y = 0; y < out.rows; ++y)
    for (int x = 0; x < out.cols; ++x) out.at<unsigned char>(y, x) = static_cast<unsigned char>(read.classes[{x, y}]);
  return out;
}

// The ground in a corner is darker than the other kind of ground in the middle. The even picture is the oracle.
TEST(EvenLight, AGreyMapInAVignetteIsReadAsWithoutIt) {
  for (const std::uint64_t seed : {5u, 6u})
    for (const int unknown : {205, 127}) {
      const cv::Mat even = grey_image(padded(truth_of({"maze", 7, 5, seed}), 20), 0, unknown, 254);
      const cv::Mat expected = classes_of(even);
      for (const double share : {0.15, 0.3, 0.4, 0.6}) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", unknown " + std::to_string(unknown) + ", vignette " +
                     std::to_string(share));
        EXPECT_LE(cv::countNonZero(classes_of(with_vignette(even, share)) != expected),
                  0.01 * static_cast<double>(expected.total()));
        std::vector<unsigned char> bytes;
        cv::imencode(".jpg", with_vignette(even, share), bytes, {cv::IMWRITE_JPEG_QUALITY, 85});
        EXPECT_LE(cv::countNonZero(classes_of(cv::imdecode(bytes, cv::IMREAD_GRAYSCALE)) != expected),
                  0.03 * static_cast<double>(expected.total()));
      }
    }
}

TEST(EvenLight, PicturesOfEvenGroundStayAsTheyAre) {
  const cv::Mat map = grey_image(padded(truth_of({"maze", 7, 5, 5}), 20), 0, 205, 254);
  EXPECT_FALSE(with_even_light(map));
  cv::Mat blurred;
  cv::GaussianBlur(map, blurred, {}, 2.0);
  EXPECT_FALSE(with_even_light(blurred));
  EXPECT_FALSE(with_even_light(cv::Mat(40, 60, CV_8U, cv::Scalar(200))));
  EXPECT_FALSE(with_even_light(cv::Mat(1, 1, CV_8U, cv::Scalar(0))));
}

// More and less sure ground in waves, which no surface of the second degree explains: that is no light.
TEST(EvenLight, ShadesOfCertaintyAreNoLight) {
  cv::Mat waves(200, 240, CV_8U);
  for (int y = 0; y < waves.rows; ++y)
    for (int x = 0; x < waves.cols; ++x)
      waves.at<unsigned char>(y, x) =
          cv::saturate_cast<unsigned char>(200 + 30 * std::sin(0.1 * x) * std::cos(0.1 * y));
  EXPECT_FALSE(with_even_light(waves));
}

}  // namespace
}  // namespace rubble::scoring
