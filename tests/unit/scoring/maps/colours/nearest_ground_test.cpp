#include "scoring/maps/colours/nearest_ground.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <vector>

namespace rubble::scoring {
namespace {

/// The nearest ground by cv::distanceTransform.
cv::Mat by_labels(const cv::Mat& no_ground, const cv::Mat& values) {
  cv::Mat distance, nearest, out(values.size(), CV_8U);
  cv::distanceTransform(no_ground, distance, nearest, cv::DIST_L2, 5, cv::DIST_LABEL_PIXEL);
  std::vector<unsigned char> of(no_ground.total() + 1);
  for (int y = 0; y < out.rows; ++y)
    for (int x = 0; x < out.cols; ++x)
      if (no_ground.at<unsigned char>(y, x) == 0)
        of[static_cast<std::size_t>(nearest.at<int>(y, x))] = values.at<unsigned char>(y, x);
  for (int y = 0; y < out.rows; ++y)
    for (int x = 0; x < out.cols; ++x)
      out.at<unsigned char>(y, x) = of[static_cast<std::size_t>(nearest.at<int>(y, x))];
  return out;
}

TEST(NearestGround, IsThatOfADistanceTransformWithLabels) {
  cv::RNG rng(5);
  for (int i = 0; i < 400; ++i) {
    const cv::Size size(rng.uniform(1, 90), rng.uniform(1, 90));
    cv::Mat values(size, CV_8U), chance(size, CV_32F);
    rng.fill(values, cv::RNG::UNIFORM, 0, 256);
    rng.fill(chance, cv::RNG::UNIFORM, 0.0, 1.0);
    const double ground = rng.uniform(0.0, 1.0);
    cv::Mat no_ground = chance > ground * ground * ground;
    no_ground.at<unsigned char>(rng.uniform(0, size.height), rng.uniform(0, size.width)) = 0;
    cv::Mat carried = values.clone();
    carry_ground(no_ground, carried);
    EXPECT_EQ(cv::countNonZero(carried != by_labels(no_ground, values)), 0) << size << ", picture " << i;
  }
}

TEST(NearestGround, WithoutGroundAllStays) {
  cv::Mat values(7, 9, CV_8U, cv::Scalar(3));
  carry_ground(cv::Mat(7, 9, CV_8U, cv::Scalar(255)), values);
  EXPECT_EQ(cv::countNonZero(values != 3), 0);
}

}  // namespace
}  // namespace rubble::scoring
