#include "scoring/maps/colours/lossy_tones.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>

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

TEST(LossyTones, WallsAndFloorsAreTheLeaguesAgain) {
  const cv::Mat league = fine_league_image(map_of(64), 0.5, false);
  for (const double power : {0.7, 1.4}) {
    const cv::Mat changed = with_gamma(league, power);
    ToneCurve curve;
    for (std::size_t i = 0; i < curve.of.size(); ++i)
      curve.of[i] = cv::saturate_cast<unsigned char>(255.0 * std::pow(static_cast<double>(i) / 255.0, power));
    const RgbImage was = to_rgb(league), now = before_tones_and_loss(to_rgb(changed), curve);
    for (std::size_t i = 0; i < was.rgb.size(); i += 3) {
      const Rgb own{was.rgb[i], was.rgb[i + 1], was.rgb[i + 2]};
      if (own != league::kWall && own != league::kFree && own != league::kUnexplored) continue;
      for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(int{now.rgb[i + k]}, int{own[k]}, 8) << "gamma " << power;
    }
  }
}

TEST(LossyTones, AMapIsReadAsBeforeAndDoubtedWhereWallsArePale) {
  const OccupancyGrid map = map_of(65);
  for (const auto& [power, doubted] : {std::pair{0.7, false}, {1.2, false}, {1.5, true}}) {
    const cv::Mat picture = as_jpeg(with_gamma(fine_league_image(map, 0.5), power), 90);
    const ClassImage read = classify(to_rgb(picture));
    EXPECT_EQ(read.refusal, "");
    EXPECT_THAT(read.recognised, HasSubstr("tones had been changed (gamma"));
    EXPECT_EQ(read.recognised.find(kDoubt) != std::string::npos, doubted) << read.recognised;
    int wrong = 0;
    for (int y = 0; y < picture.rows; ++y)
      for (int x = 0; x < picture.cols; ++x) {
        const Cell cell{x / 2, map.height() - 1 - y / 2};
        wrong += read.classes[{x, picture.rows - 1 - y}] != map[cell] ? 1 : 0;
      }
    EXPECT_LE(wrong, picture.rows * picture.cols / 100) << "gamma " << power;
  }
}

}  // namespace
}  // namespace rubble::scoring
