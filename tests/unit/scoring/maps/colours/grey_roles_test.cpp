#include "scoring/maps/colours/grey_roles.h"

#include <gtest/gtest.h>

#include "base/rng.h"

namespace rubble::scoring {
namespace {

constexpr int kWall = 0, kUnknown = 127, kFree = 255;

/// A building as a laser maps it: free rooms, walls of one pixel between free and unknown ground, and behind windows
/// many specks of wall that have unknown ground on both sides.
cv::Mat laser_map(std::uint64_t seed, int unknown, int free) {
  cv::Mat grey(400, 400, CV_8U, cv::Scalar(unknown));
  for (int room = 0; room < 3; ++room) {
    const cv::Rect box(60 + 90 * room, 80, 85, 200);
    grey(box).setTo(kWall);
    grey(cv::Rect(box.x + 1, box.y + 1, box.width - 2, box.height - 2)).setTo(free);
  }
  Rng rng(seed, "specks");
  for (int i = 0; i < 3000; ++i) {
    const int x = 2 + static_cast<int>(rng.below(396));
    const int y = 2 + static_cast<int>(rng.below(396));
    if (y < 60 || y > 300) grey.at<unsigned char>(y, x) = kWall;
  }
  return grey;
}

TEST(GreyRoles, SpecksInUnknownGroundDoNotMakeItFree) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const cv::Mat apart = cv::Mat::zeros(400, 400, CV_8U);
    const GreyRoles roles = grey_roles(laser_map(seed, kUnknown, kFree), apart);
    EXPECT_EQ(roles.wall, kWall) << "seed " << seed;
    EXPECT_EQ(roles.unknown, kUnknown) << "seed " << seed;
    EXPECT_EQ(roles.free, kFree) << "seed " << seed;
    EXPECT_GT(roles.sure, 0.5);
  }
}

/// Greys out of order are told by the walls within free ground, and the rim agrees.
TEST(GreyRoles, GroundOnBothSidesOfWallsAndNotOnTheRimIsFree) {
  cv::Mat grey(400, 400, CV_8U, cv::Scalar(kFree));
  grey(cv::Rect(60, 60, 280, 280)).setTo(kWall);
  grey(cv::Rect(62, 62, 276, 276)).setTo(kUnknown);
  for (int i = 1; i < 7; ++i) grey(cv::Rect(62 + 40 * i, 62, 2, 180)).setTo(kWall);
  const GreyRoles roles = grey_roles(grey, cv::Mat::zeros(400, 400, CV_8U));
  EXPECT_EQ(roles.free, kUnknown);
  EXPECT_EQ(roles.unknown, kFree);
}

}  // namespace
}  // namespace rubble::scoring
