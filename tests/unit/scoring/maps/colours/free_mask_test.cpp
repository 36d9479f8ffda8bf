#include "scoring/maps/colours/free_mask.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tests/support/map_pictures.h"
#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;

cv::Mat nothing(const cv::Mat& of) { return cv::Mat::zeros(of.size(), CV_8U); }

/// Walls in black on a page, as a paint program has them.
cv::Mat plan() { return grey_image(padded(maze({6, 6, 3}), 10), 0, 255, 255); }

TEST(FreeMask, IsToldByTheGreyAroundItThatDrawsThinLines) {
  const OccupancyGrid map = padded(with_gaps(maze({6, 6, 3}), 12, 3), 10);
  for (const int rest : {0, 90, 255}) {
    const int free = rest == 255 ? 0 : 254;
    const cv::Mat picture = grey_image(map, rest, rest, free);
    const auto mask = free_mask(picture, nothing(picture));
    ASSERT_TRUE(mask.has_value()) << rest;
    EXPECT_EQ(cv::countNonZero(mask->free != (picture == free)), 0) << rest;
    // Of the walls no cell is lost, and what lies behind the walls around is none.
    int lost = 0;
    for (int y = 0; y < map.height(); ++y)
      for (int x = 0; x < map.width(); ++x)
        lost += map[{x, map.height() - 1 - y}] == Occupancy::Occupied && mask->walls.at<unsigned char>(y, x) == 0;
    EXPECT_LE(lost, 8) << rest;  // corners
    EXPECT_EQ(mask->walls.at<unsigned char>(2, 2), 0) << rest;
  }
}

TEST(FreeMask, IsNoDrawingOfWallsOnAPage) {
  const cv::Mat picture = plan();
  EXPECT_FALSE(free_mask(picture, nothing(picture)).has_value());
  EXPECT_FALSE(free_mask(~picture, nothing(picture)).has_value());
}

/// Racks in a store: obstacles on free ground, with aisles between them hardly narrower than they are wide.
TEST(FreeMask, IsNoPlanOfRacks) {
  cv::Mat picture(180, 240, CV_8U, cv::Scalar(255));
  for (int x = 20; x < 220; x += 22) picture(cv::Rect(x, 20, 12, 140)).setTo(0);
  EXPECT_FALSE(free_mask(picture, nothing(picture)).has_value());
  EXPECT_FALSE(free_mask(~picture, nothing(picture)).has_value());
}

/// The page lies on black, upright: without that its walls enclose free ground.
TEST(FreeMask, IsNoPageOnACanvasOfTheWallsGrey) {
  cv::Mat picture;
  cv::copyMakeBorder(plan(), picture, 40, 40, 40, 40, cv::BORDER_CONSTANT, cv::Scalar(0));
  EXPECT_FALSE(free_mask(picture, nothing(picture)).has_value());
}

TEST(FreeMask, IsNoMapOfThreeGreys) {
  const OccupancyGrid map = padded(maze({6, 6, 3}), 10);
  for (const int unknown : {60, 128, 205}) {
    const cv::Mat picture = grey_image(map, 0, unknown, 254);
    EXPECT_FALSE(free_mask(picture, nothing(picture)).has_value()) << unknown;
  }
}

}  // namespace
}  // namespace rubble::scoring
