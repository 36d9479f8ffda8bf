#include "scoring/maps/colours/blur.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "base/grid.h"
#include "scoring/maps/colours/map_colours.h"
#include "tests/support/map_pictures.h"
#include "tests/support/scoring_grounds.h"

namespace rubble::scoring {
namespace {

using namespace testing;

cv::Mat maze_drawn(std::uint64_t seed, double searched) {
  return fine_league_image(truth_of({"maze", 7, 5, seed}), searched, false);
}

cv::Mat blurred(const cv::Mat& picture, double sigma) {
  cv::Mat out;
  cv::GaussianBlur(picture, out, {}, sigma);
  return out;
}

cv::Mat walls_read(const cv::Mat& picture) {
  const ClassImage image = classify(to_rgb(picture));
  EXPECT_EQ(image.refusal, "");
  cv::Mat out = cv::Mat::zeros(picture.size(), CV_8U);
  for (int y = 0; y < out.rows; ++y)
    for (int x = 0; x < out.cols; ++x)
      if (image.classes[{x, out.rows - 1 - y}] == Occupancy::Occupied) out.at<unsigned char>(y, x) = 255;
  return out;
}

// The sharp picture is the oracle.
TEST(Blur, WallsOfALeagueMapOutliveIt) {
  for (const std::uint64_t seed : {5u, 6u})
    for (const double searched : {0.0, 0.5, 1.0})
      for (const double sigma : {1.2, 1.5, 1.8, 2.2, 2.6}) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", searched " + std::to_string(searched) + ", blurred by " +
                     std::to_string(sigma));
        const cv::Mat sharp = maze_drawn(seed, searched), soft = blurred(sharp, sigma);
        EXPECT_NEAR(blur_of(to_rgb(soft)).sigma, sigma, 0.35);
        const cv::Mat oracle = walls_read(sharp), walls = walls_read(soft);
        EXPECT_LE(apart(oracle, walls), 0.01);
        EXPECT_LE(apart(walls, oracle), 0.01);
      }
}

TEST(Blur, WallsOutliveJpegAfterIt) {
  for (const std::uint64_t seed : {5u, 6u})
    for (const double searched : {0.0, 1.0})
      for (const double sigma : {1.4, 1.8})
        for (const int quality : {90, 75}) {
          SCOPED_TRACE("seed " + std::to_string(seed) + ", searched " + std::to_string(searched) + ", blurred by " +
                       std::to_string(sigma) + ", quality " + std::to_string(quality));
          const cv::Mat sharp = maze_drawn(seed, searched);
          const cv::Mat oracle = walls_read(sharp), walls = walls_read(as_jpeg(blurred(sharp, sigma), quality));
          EXPECT_LE(apart(oracle, walls), 0.05);
          EXPECT_LE(apart(walls, oracle), 0.05);
        }
}

TEST(Blur, SharpEdgesHaveNone) {
  for (const double searched : {0.0, 1.0}) {
    const cv::Mat sharp = maze_drawn(5, searched);
    cv::Mat turned, smaller;
    cv::warpAffine(sharp, turned, cv::getRotationMatrix2D({100, 100}, 13.0, 1.0), sharp.size(), cv::INTER_CUBIC,
                   cv::BORDER_CONSTANT, {227, 226, 226});
    cv::resize(sharp, smaller, {}, 0.8, 0.8, cv::INTER_AREA);
    for (const cv::Mat& picture : {sharp, turned, smaller, as_jpeg(sharp, 90), as_jpeg(sharp, 40)})
      EXPECT_EQ(blur_of(to_rgb(picture)).sigma, 0.0);
  }
}

TEST(Blur, WhatIsNotReadWellIsNamed) {
  int named = 0;
  for (const std::uint64_t seed : {5u})
    for (const bool fine : {false, true})
      for (const double sigma : {2.2, 3.8}) {
        SCOPED_TRACE("seed " + std::to_string(seed) + (fine ? ", fine" : ", coarse") + ", blurred by " +
                     std::to_string(sigma));
        const OccupancyGrid maze = truth_of({"maze", 7, 5, seed});
        const cv::Mat sharp = fine ? fine_league_image(maze, 0.5, false) : league_image(maze, true);
        const cv::Mat soft = blurred(sharp, sigma);
        const ClassImage image = classify(to_rgb(soft));
        const std::string said = image.recognised + ' ' + image.refusal;
        if (said.find("blurred") == std::string::npos) ADD_FAILURE() << said;
        if (image.refusal.empty() && said.find("pale") == std::string::npos) {
          EXPECT_LE(apart(walls_read(sharp), walls_read(soft)), 0.1);
        } else {
          ++named;
        }
      }
  EXPECT_GT(named, 0);
}

TEST(Blur, ColoursThatWereLostBeforeItAreWhatIsNamed) {
  const cv::Mat sharp = maze_drawn(5, 0.5);
  cv::Mat grey;
  cv::cvtColor(sharp, grey, cv::COLOR_BGR2GRAY);
  cv::cvtColor(grey, grey, cv::COLOR_GRAY2BGR);
  const std::string lost = classify(to_rgb(grey)).refusal;
  ASSERT_NE(lost, "");
  for (const double sigma : {0.0, 1.4, 1.8}) {
    const ClassImage image = classify(to_rgb(blurred(grey, sigma > 0.0 ? sigma : 0.01)));
    EXPECT_NE(image.refusal, "") << sigma;
    EXPECT_EQ(image.refusal.find("blurred too much"), std::string::npos) << sigma << ": " << image.refusal;
  }
}

}  // namespace
}  // namespace rubble::scoring
