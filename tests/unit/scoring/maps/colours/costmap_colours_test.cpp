#include "scoring/maps/colours/costmap_colours.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <string>

#include "scoring/maps/colours/map_colours.h"
#include "scoring/maps/colours/reading_doubts.h"
#include "tests/support/map_pictures.h"
#include "tests/support/map_style_hard.h"
#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::Not;

/// Over a map in RViz's greys, of which costs of 0 show all.
Colour half_transparent(int cost, double opacity) {
  const Colour below = cost < 0 ? Colour(134, 137, 112) : cost == 100 ? kBlack : grey(230);
  if (cost <= 0) return below;
  const Colour own = rviz_cost(cost);
  Colour out;
  for (int i = 0; i < 3; ++i) out[i] = cv::saturate_cast<unsigned char>(opacity * own[i] + (1.0 - opacity) * below[i]);
  return out;
}

void expect_read_as(const cv::Mat& picture, const OccupancyGrid& map, int scale) {
  const ClassImage read = classify(to_rgb(picture));
  EXPECT_EQ(read.refusal, "");
  EXPECT_THAT(read.recognised, HasSubstr("costmap"));
  EXPECT_THAT(read.recognised, Not(HasSubstr(kDoubt)));
  int wrong = 0;
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      wrong += read.classes[{x, picture.rows - 1 - y}] != map[{x / scale, map.height() - 1 - y / scale}] ? 1 : 0;
  EXPECT_LE(wrong, picture.rows * picture.cols / 1000);
}

TEST(CostmapColours, ObstaclesAreWallsAndCostsFreeAtAnyOpacityAndScale) {
  for (const std::uint64_t seed : {3U, 4U, 5U}) {
    const OccupancyGrid map = padded(maze_of(seed, 6, 6), 12);
    for (const int scale : {1, 2})
      for (const Inflation& inflation :
           {Inflation{0.15, 0.6, 5.0}, Inflation{0.25, 0.9, 3.0}, Inflation{0.12, 1.2, 2.0}}) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed << ", scale " << scale << ", " << inflation.radius);
        expect_read_as(costmap(map, scale, inflation, rviz_cost), map, scale);
        for (const double opacity : {0.35, 0.5, 0.7}) {
          SCOPED_TRACE(opacity);
          expect_read_as(costmap(map, scale, inflation, [=](int cost) { return half_transparent(cost, opacity); }), map,
                         scale);
        }
      }
  }
}

TEST(CostmapColours, MapsWithMagentaDrawingsAreNone) {
  const OccupancyGrid map = padded(maze_of(3, 6, 6), 12);
  cv::Mat picture = in_ros_greys(map, 2);
  cv::polylines(picture, way_of(map, 2), false, cv::Scalar(255, 0, 255), 3);
  cv::circle(picture, 2 * open_place(map, 5, 1), 8, cv::Scalar(255, 255, 0), cv::FILLED);
  EXPECT_FALSE(classify_costmap(to_rgb(picture)).has_value());
  EXPECT_FALSE(classify_costmap(to_rgb(league_image(map, true))).has_value());
}

}  // namespace
}  // namespace rubble::scoring
