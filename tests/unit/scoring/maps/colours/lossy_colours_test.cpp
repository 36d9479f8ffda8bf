#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "scoring/maps/colours/league_classes.h"
#include "scoring/maps/colours/league_colours.h"
#include "tests/support/map_pictures.h"
#include "tests/support/scoring_grounds.h"

namespace rubble::scoring {
namespace {

using namespace testing;

constexpr int kWallOfLeague = 2;

cv::Mat walls_of(const cv::Mat& picture) { return classify_league(to_rgb(picture)).classes == kWallOfLeague; }

/// Walls two pixels wide.
cv::Mat two_pixel_walls(std::uint64_t seed, double searched) {
  return fine_league_image(truth_of({"maze", 7, 5, seed}), searched);
}

// Half as many pixels leave walls half as dark, and JPEG takes most of their colour: the small picture without JPEG is
// the oracle.
TEST(LossyColours, WallsMadeSmallerOutliveJpeg) {
  for (const std::uint64_t seed : {5u, 6u})
    for (const double searched : {0.0, 0.5, 1.0})
      for (const int filter : {cv::INTER_AREA, cv::INTER_LINEAR, cv::INTER_CUBIC})
        for (const int quality : {90, 75, 60}) {
          SCOPED_TRACE("seed " + std::to_string(seed) + ", searched " + std::to_string(searched) + ", filter " +
                       std::to_string(filter) + ", quality " + std::to_string(quality));
          cv::Mat small;
          cv::resize(two_pixel_walls(seed, searched), small, {}, 0.5, 0.5, filter);
          const cv::Mat oracle = walls_of(small), walls = walls_of(as_jpeg(small, quality));
          EXPECT_LE(apart(oracle, walls), 0.06);
          EXPECT_LE(apart(walls, oracle), 0.06);
        }
}

// Blue is the nearest colour to that of walls; letters of it on green or white floor are as dark.
TEST(LossyColours, BlueWordsAreNoWalls) {
  for (const double searched : {0.0, 1.0})
    for (const int quality : {85, 60}) {
      SCOPED_TRACE("searched " + std::to_string(searched) + ", quality " + std::to_string(quality));
      const cv::Mat plain = two_pixel_walls(5, searched);
      cv::Mat noted = plain.clone();
      for (const int row : {90, 150, 210})
        cv::putText(noted, "TEAM X RUN 3", {70, row}, cv::FONT_HERSHEY_SIMPLEX, 0.6, {255, 0, 0}, 2, cv::LINE_AA);
      EXPECT_LE(apart(walls_of(as_jpeg(noted, quality)), walls_of(plain)), 0.06);
    }
}

// What is drawn on a map of greys does not make it one of the league's, nor does a canvas of one of its greys.
TEST(LossyColours, GreyMapsAreNoLeagueMaps) {
  const cv::Mat grey = grey_image(truth_of({"maze", 7, 5, 5}), 0, 205, 254);
  cv::Mat drawn;
  cv::cvtColor(grey, drawn, cv::COLOR_GRAY2BGR);
  EXPECT_FALSE(is_league_map(to_rgb(turned(drawn, 20, cv::INTER_LINEAR, {227, 226, 226}).image)));
  cv::circle(drawn, {90, 60}, 20, {255, 0, 0}, 2);
  cv::arrowedLine(drawn, {30, 30}, {60, 90}, {255, 0, 0}, 2);
  for (const int quality : {95, 85, 60}) EXPECT_FALSE(is_league_map(to_rgb(as_jpeg(drawn, quality)))) << quality;
}

}  // namespace
}  // namespace rubble::scoring
