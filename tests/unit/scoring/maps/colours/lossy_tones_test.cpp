#include "scoring/maps/colours/lossy_tones.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "scoring/maps/colours/league_palette.h"
#include "scoring/maps/colours/map_colours.h"
#include "scoring/maps/colours/reading_doubts.h"
#include "tests/support/map_pictures.h"
#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::Not;

cv::Mat with_gamma(const cv::Mat& picture, double power) {
  cv::Mat curve(1, 256, CV_8U), out;
  for (int i = 0; i < 256; ++i)
    curve.at<unsigned char>(i) = cv::saturate_cast<unsigned char>(255.0 * std::pow(i / 255.0, power));
  cv::LUT(picture, curve, out);
  return out;
}

OccupancyGrid map_of(std::uint64_t seed) { return padded(maze_of(seed, 5, 6), 14); }

TEST(LossyTones, AGammaIsFoundThroughJpegWhereItLeftWallsTheirColour) {
  for (const std::uint64_t seed : {61U, 62U})
    for (const double power : {0.6, 0.8, 1.15, 1.3, 1.5})
      for (const double searched : {0.0, 0.6})
        for (const int quality : {95, 80, 60}) {
          SCOPED_TRACE(::testing::Message() << "seed " << seed << ", gamma " << power << ", searched " << searched
                                            << ", quality " << quality);
          const cv::Mat picture = with_gamma(fine_league_image(map_of(seed), searched), power);
          const std::optional<ToneCurve> curve = tone_curve_before_loss(to_rgb(as_jpeg(picture, quality)));
          ASSERT_TRUE(curve.has_value());
          for (const int value : {40, 120, 226, 237, 255})
            EXPECT_NEAR(curve->of[static_cast<std::size_t>(value)], 255.0 * std::pow(value / 255.0, power),
                        6.0);  // a grey of the squares more or less
        }
}

TEST(LossyTones, NothingIsFoundInPicturesOfOldNorWhereWallsLostTheirColour) {
  const OccupancyGrid map = map_of(63);
  const cv::Mat league = fine_league_image(map, 0.4), grey = grey_image(map, 0, 205, 254);
  cv::Mat ros;
  cv::cvtColor(grey, ros, cv::COLOR_GRAY2BGR);
  for (const int quality : {95, 70})
    for (const cv::Mat& picture : {league, ros, with_gamma(league, 2.2)})
      EXPECT_FALSE(tone_curve_before_loss(to_rgb(as_jpeg(picture, quality))).has_value());
  EXPECT_EQ(doubt_about_tones(to_rgb(as_jpeg(league, 80))), "");
  EXPECT_THAT(doubt_about_tones(to_rgb(as_jpeg(with_gamma(league, 1.3), 80))), HasSubstr("checkerboard"));
}

ToneCurve curve_of_gamma(double power) {
  ToneCurve out;
  for (std::size_t i = 0; i < out.of.size(); ++i)
    out.of[i] = cv::saturate_cast<unsigned char>(255.0 * std::pow(static_cast<double>(i) / 255.0, power));
  return out;
}

ToneCurve curve_of_line(double gain, double offset) {
  ToneCurve out;
  for (std::size_t i = 0; i < out.of.size(); ++i)
    out.of[i] = cv::saturate_cast<unsigned char>(gain * static_cast<double>(i) + offset);
  return out;
}

cv::Mat through(const cv::Mat& picture, const ToneCurve& curve) {
  cv::Mat out;
  cv::LUT(picture, cv::Mat(1, 256, CV_8U, const_cast<std::uint8_t*>(curve.of.data())), out);
  return out;
}

/// Contrast and brightness that leave squares and white apart; the first three clip white.
const std::vector<std::pair<double, double>> kStraightCurves{
    {1.0, 10.0}, {1.05, -2.0}, {1.2, -30.0}, {0.9, 10.0}, {1.0, -20.0}};

TEST(LossyTones, WallsAndFloorsAreTheLeaguesAgain) {
  const std::array<Rgb, 6> grounds{league::kWall,       league::kFree,
                                   league::kUnexplored, league::kUnexploredLight,
                                   league::kSearched,   league::kSearchedUnsure};
  cv::Mat league = fine_league_image(map_of(64), 0.5, false);
  cv::Mat upper = league.rowRange(0, league.rows / 2);
  const auto in_mat = [](const Rgb& c) { return cv::Scalar(c[2], c[1], c[0]); };
  cv::Mat searched;
  cv::inRange(upper, in_mat(league::kSearched), in_mat(league::kSearched), searched);
  upper.setTo(in_mat(league::kSearchedUnsure), searched);
  std::vector<ToneCurve> curves{curve_of_gamma(0.7), curve_of_gamma(1.4)};
  for (const auto& [gain, offset] : kStraightCurves) curves.push_back(curve_of_line(gain, offset));
  for (std::size_t at = 0; at < curves.size(); ++at) {
    const RgbImage was = to_rgb(league), now = before_tones_and_loss(to_rgb(through(league, curves[at])), curves[at]);
    std::array<int, 6> seen{};
    for (std::size_t i = 0; i < was.rgb.size(); i += 3) {
      const Rgb own{was.rgb[i], was.rgb[i + 1], was.rgb[i + 2]};
      const auto ground = std::find(grounds.begin(), grounds.end(), own);
      if (ground == grounds.end()) continue;
      ++seen[static_cast<std::size_t>(ground - grounds.begin())];
      for (std::size_t k = 0; k < 3; ++k)
        ASSERT_NEAR(int{now.rgb[i + k]}, int{own[k]}, 10) << "curve " << at << ", value " << int{own[1]};
    }
    for (const int pixels : seen) EXPECT_GT(pixels, 0);
  }
}

/// White that was clipped is white again, and what JPEG took off it is no unexplored ground.
TEST(LossyTones, WhiteThatWasClippedIsNoUnexploredGround) {
  for (const auto& [gain, offset] : kStraightCurves) {
    const ToneCurve curve = curve_of_line(gain, offset);
    RgbImage image(4, 1);
    for (int x = 0; x < 4; ++x) std::fill_n(image.pixel(x, 0), 3, static_cast<std::uint8_t>(curve.of[255] - x));
    const RgbImage before = before_tones_and_loss(image, curve);
    EXPECT_EQ(before.pixel(0, 0)[1], 255) << gain << ' ' << offset;
    // Where a picture is clipped down to the squares, nothing tells: that is doubted.
    const int apart = white_over_squares(curve);
    for (int x = 1; x < std::min(4, apart / 2); ++x)
      EXPECT_GT(before.pixel(x, 0)[1], 246) << gain << ' ' << offset << ", less by " << x;
  }
}

TEST(LossyTones, ACurveThatLeavesNoColourGivesGreys) {
  ToneCurve curve;
  curve.of.fill(77);
  RgbImage image(1, 1);
  const Rgb colour{90, 77, 60};
  std::copy(colour.begin(), colour.end(), image.pixel(0, 0));
  const RgbImage before = before_tones_and_loss(image, curve);
  EXPECT_EQ(before.pixel(0, 0)[0], before.pixel(0, 0)[1]);
  EXPECT_EQ(before.pixel(0, 0)[2], before.pixel(0, 0)[1]);
}

/// Pixels of a picture of two a cell that are not as the map is.
int read_wrong(const ClassImage& read, const OccupancyGrid& map) {
  const GridFrame& frame = read.classes.frame();
  int wrong = 0;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) wrong += read.classes[{x, y}] != map[{x / 2, y / 2}] ? 1 : 0;
  return wrong;
}

TEST(LossyTones, AMapOfOtherContrastIsReadAsBeforeOrDoubted) {
  int silent = 0;
  const OccupancyGrid map = map_of(66);
  for (const double searched : {0.0, 0.5})
    for (const auto& [gain, offset] : kStraightCurves)
      for (const int quality : {95, 80}) {
        SCOPED_TRACE(::testing::Message()
                     << "searched " << searched << ", " << gain << " times " << offset << ", quality " << quality);
        const cv::Mat league = fine_league_image(map, searched);
        const cv::Mat picture = as_jpeg(through(league, curve_of_line(gain, offset)), quality);
        const ClassImage read = classify(to_rgb(picture));
        if (!read.refusal.empty() || read.recognised.find(kDoubt) != std::string::npos) continue;
        const ClassImage unchanged = classify(to_rgb(as_jpeg(league, quality)));
        EXPECT_LE(read_wrong(read, map), read_wrong(unchanged, map) + picture.rows * picture.cols / 100)
            << read.recognised;
        ++silent;
      }
  EXPECT_GE(silent, 10);  // of 20
}

TEST(LossyTones, AMapIsReadAsBeforeAndDoubtedWhereWallsArePale) {
  const OccupancyGrid map = map_of(65);
  for (const auto& [power, doubted] : {std::pair{0.7, false}, {1.2, false}, {1.5, true}}) {
    const cv::Mat picture = as_jpeg(with_gamma(fine_league_image(map, 0.5), power), 90);
    const ClassImage read = classify(to_rgb(picture));
    EXPECT_EQ(read.refusal, "");
    EXPECT_THAT(read.recognised, HasSubstr("tones had been changed (gamma"));
    EXPECT_EQ(read.recognised.find(kDoubt) != std::string::npos, doubted) << read.recognised;
    EXPECT_LE(read_wrong(read, map), picture.rows * picture.cols / 100) << "gamma " << power;
  }
}

}  // namespace
}  // namespace rubble::scoring
