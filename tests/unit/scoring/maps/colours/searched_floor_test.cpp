#include "scoring/maps/colours/searched_floor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "scoring/maps/colours/league_classes.h"
#include "scoring/maps/colours/league_colours.h"
#include "tests/support/map_pictures.h"
#include "tests/support/scoring_grounds.h"

namespace rubble::scoring {
namespace {

using namespace testing;

struct Change {
  std::string name;
  std::function<cv::Mat(const cv::Mat&)> of;
};

Change jpeg(int quality) {
  return {"JPEG of quality " + std::to_string(quality), [quality](const cv::Mat& picture) {
            std::vector<unsigned char> bytes;
            cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
            return cv::imdecode(bytes, cv::IMREAD_COLOR);
          }};
}

std::vector<Change> changes() {
  std::vector<Change> out = {jpeg(95), jpeg(75), jpeg(50), jpeg(35)};
  out.push_back({"blurred", [](const cv::Mat& picture) {
                   cv::Mat blurred;
                   cv::GaussianBlur(picture, blurred, {}, 1.0);
                   return blurred;
                 }});
  out.push_back(
      {"turned", [](const cv::Mat& picture) {
         const cv::Point2d middle(0.5 * picture.cols, 0.5 * picture.rows);
         const cv::Mat turn = cv::getRotationMatrix2D(cv::Point2f(middle), 8.0, 1.0);
         cv::Mat turned;
         cv::warpAffine(picture, turned, turn, picture.size(), cv::INTER_CUBIC, cv::BORDER_CONSTANT, {227, 226, 226});
         return turned;
       }});
  out.push_back({"smaller", [](const cv::Mat& picture) {
                   cv::Mat smaller;
                   cv::resize(picture, smaller, {}, 0.8, 0.8, cv::INTER_AREA);
                   return smaller;
                 }});
  out.push_back({"a coarse one of a fine one", [](const cv::Mat& picture) {
                   cv::Mat fine, coarse;
                   cv::resize(picture, fine, {}, 2.0, 2.0, cv::INTER_NEAREST);
                   cv::copyMakeBorder(fine, fine, 1, 1, 1, 1, cv::BORDER_CONSTANT, {227, 226, 226});
                   cv::resize(fine, coarse, {}, 0.5, 0.5, cv::INTER_AREA);
                   return coarse;
                 }});
  return out;
}

Change resized(double factor, int interpolation) {
  return {"resized by " + std::to_string(factor) + ", interpolation " + std::to_string(interpolation),
          [=](const cv::Mat& picture) {
            cv::Mat out;
            cv::resize(picture, out, {}, factor, factor, interpolation);
            return out;
          }};
}

/// A map whose walls are two pixels wide, as they are drawn here.
cv::Mat fine_picture(std::uint64_t seed) {
  cv::Mat fine;
  cv::resize(league_image(truth_of({"maze", 7, 5, seed}), false), fine, {}, 2.0, 2.0, cv::INTER_NEAREST);
  return fine;
}

// Bicubic and Lanczos filters exaggerate the contrast of walls, whose colour then is none of the league's; plain
// enlarging without a filter is the oracle.
TEST(LeagueWalls, OutliveSharpFilters) {
  const cv::Mat fine = fine_picture(5);
  for (const bool searched : {false, true})
    for (const double factor : {0.7, 0.8, 1.25, 1.4})
      for (const int interpolation : {cv::INTER_CUBIC, cv::INTER_LANCZOS4}) {
        SCOPED_TRACE(std::to_string(factor) + ", " + std::to_string(interpolation) + (searched ? ", searched" : ""));
        const cv::Mat picture = searched ? with_searched_floor(fine) : fine;
        const cv::Mat of_picture = classify_league(to_rgb(resized(factor, interpolation).of(picture))).classes;
        const cv::Mat plain = classify_league(to_rgb(resized(factor, cv::INTER_NEAREST).of(fine))).classes;
        constexpr int kWall = 2;
        cv::Mat beside_wall;
        cv::dilate(of_picture == kWall, beside_wall, cv::Mat::ones(3, 3, CV_8U));
        EXPECT_LE(cv::countNonZero((plain == kWall) & ~beside_wall), 0.02 * cv::countNonZero(plain == kWall));
        cv::Mat beside_plain;
        cv::dilate(plain == kWall, beside_plain, cv::Mat::ones(3, 3, CV_8U));
        EXPECT_LE(cv::countNonZero((of_picture == kWall) & ~beside_plain), 0.02 * cv::countNonZero(plain == kWall));
      }
}

// The same map with white floor is the oracle.
TEST(SearchedFloor, IsReadAsOtherFreeFloorHoweverThePictureWasStored) {
  for (const std::uint64_t seed : {5u, 6u}) {
    const cv::Mat white = league_image(truth_of({"maze", 7, 5, seed}), false);
    const cv::Mat green = with_searched_floor(white);
    ASSERT_EQ(cv::countNonZero(classify_league(to_rgb(white)).classes != classify_league(to_rgb(green)).classes), 0);
    for (const Change& change : changes()) {
      SCOPED_TRACE(change.name + ", seed " + std::to_string(seed));
      const cv::Mat of_white = classify_league(to_rgb(change.of(white))).classes;
      const cv::Mat of_green = classify_league(to_rgb(change.of(green))).classes;
      constexpr int kWall = 2;
      const cv::Mat walls = (of_white == kWall) | (of_green == kWall);
      const cv::Mat differ = of_white != of_green;
      EXPECT_LE(cv::countNonZero(differ & walls), 0.06 * cv::countNonZero(walls));
      EXPECT_LE(cv::countNonZero(differ & ~walls), 0.01 * static_cast<double>(of_white.total()));
    }
  }
}

// One change of all tones, as an editor makes it, on a map that was searched all over and has no white.
TEST(SearchedFloor, ChangedTonesAreUndone) {
  const cv::Mat green = with_searched_floor(league_image(truth_of({"maze", 7, 5, 5}), true), 1.0);
  const cv::Mat expected = classify_league(to_rgb(green)).classes;
  struct Tone {
    double gain, offset, gamma;
  };
  for (const Tone& tone : {Tone{1.1, -18.0, 1.0},
                           {1.05, 0.0, 1.0},
                           {0.95, 0.0, 1.0},
                           {0.6, 70.0, 1.0},
                           {0.8, 0.0, 1.0},
                           {1.0, 0.0, 0.7},
                           {1.0, 0.0, 1.6}}) {
    SCOPED_TRACE(::testing::PrintToString(std::vector<double>{tone.gain, tone.offset, tone.gamma}));
    cv::Mat table(1, 256, CV_8U), changed;
    for (int i = 0; i < 256; ++i)
      table.at<unsigned char>(i) = cv::saturate_cast<unsigned char>(
          255.0 * std::pow(std::clamp((tone.gain * i + tone.offset) / 255.0, 0.0, 1.0), tone.gamma));
    cv::LUT(green, table, changed);
    const auto restored = restored_league_colours(to_rgb(changed));
    ASSERT_TRUE(restored);
    EXPECT_EQ(cv::countNonZero(classify_league(restored->image).classes != expected), 0);
  }
}

TEST(SearchedFloor, AGreyCopyIsRefusedAsThatOfAWhiteMapIs) {
  for (const double share : {0.0, 1.0}) {
    cv::Mat grey, picture;
    cv::cvtColor(with_searched_floor(league_image(truth_of({"maze", 7, 5, 5}), true), share), grey, cv::COLOR_BGR2GRAY);
    cv::cvtColor(grey, picture, cv::COLOR_GRAY2BGR);
    EXPECT_NE(why_colours_are_lost(to_rgb(picture), false).find("without its colours"), std::string::npos) << share;
  }
}

// Walls of one pixel, of which JPEG leaves the brightness alone.
TEST(SearchedFloor, ThinWallsOutliveJpeg) {
  constexpr int kWall = 2;
  cv::Mat picture = fine_picture(6);
  const cv::Mat thick = classify_league(to_rgb(picture)).classes == kWall;
  // Of each wall the western or northern row of pixels.
  cv::Mat core;
  cv::erode(thick, core, cv::Mat::ones(2, 2, CV_8U), {1, 1});
  const cv::Mat thin = thick & ~core;
  ASSERT_GT(cv::countNonZero(thin), 1000);
  picture.setTo(cv::Scalar(255, 255, 255), thick & ~thin);
  for (const double share : {0.0, 1.0})
    for (const int quality : {92, 75}) {
      SCOPED_TRACE(::testing::PrintToString(std::pair(share, quality)));
      const cv::Mat of_green = classify_league(to_rgb(jpeg(quality).of(with_searched_floor(picture, share)))).classes;
      cv::Mat near;
      cv::dilate(of_green == kWall, near, cv::Mat::ones(3, 3, CV_8U));
      EXPECT_LE(cv::countNonZero(thin & ~near), 0.05 * cv::countNonZero(thin));
      cv::Mat beside_thin;
      cv::dilate(thin, beside_thin, cv::Mat::ones(3, 3, CV_8U));
      EXPECT_LE(cv::countNonZero((of_green == kWall) & ~beside_thin), 0.05 * cv::countNonZero(thin));
    }
}

TEST(SearchedFloor, PicturesWithoutItStayAsTheyAre) {
  const RgbImage plain = to_rgb(league_image(truth_of({"maze", 7, 5, 5}), true));
  EXPECT_EQ(without_searched_floor(plain).rgb, plain.rgb);
}

}  // namespace
}  // namespace rubble::scoring
