#include "scoring/maps/colours/grey_roles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <opencv2/imgproc.hpp>

#include "base/rng.h"
#include "scoring/maps/colours/map_colours.h"
#include "tests/support/map_pictures.h"
#include "tests/support/scoring_grounds.h"
#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;

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

constexpr int kWindow = 120;  // of it beside the map [pixels]

/// What RViz shows: its own unknown grey, a window around, a grid over all, the robot's axes in the middle.
cv::Mat in_rviz(const OccupancyGrid& grid, int scale) {
  cv::Mat image(grid.height(), grid.width(), CV_8UC3);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) {
      const Occupancy o = grid[{x, grid.height() - 1 - y}];
      image.at<cv::Vec3b>(y, x) = o == Occupancy::Occupied ? cv::Vec3b(0, 0, 0)
                                  : o == Occupancy::Free   ? cv::Vec3b(255, 255, 255)
                                                           : cv::Vec3b(134, 137, 112);
    }
  cv::resize(image, image, {}, scale, scale, cv::INTER_NEAREST);
  cv::copyMakeBorder(image, image, kWindow, kWindow, kWindow, kWindow, cv::BORDER_CONSTANT, cv::Scalar(48, 48, 48));
  cv::Mat lined = image.clone();
  for (int i = 0; i < std::max(image.cols, image.rows); i += 20 * scale) {
    cv::line(lined, {i, 0}, {i, image.rows}, {164, 160, 160});
    cv::line(lined, {0, i}, {image.cols, i}, {164, 160, 160});
  }
  cv::addWeighted(lined, 0.5, image, 0.5, 0.0, image);
  const cv::Point middle(image.cols / 2 + 15, image.rows / 2 + 15);
  cv::line(image, middle, middle + cv::Point(30, 0), {0, 0, 255}, 3);
  cv::line(image, middle, middle - cv::Point(0, 30), {0, 255, 0}, 3);
  return image;
}

// The window around has a grey of its own, so that the map's unknown ground, darker than half, is neither.
TEST(GreyMaps, AViewersWindowGridAndAxesAreNoWalls) {
  const OccupancyGrid truth = truth_of({"maze", 7, 5, 5});
  const OccupancyGrid grid = padded(truth, 8);
  for (const double shrunk : {1.0, 0.8}) {
    SCOPED_TRACE(shrunk);
    cv::Mat picture;
    cv::resize(in_rviz(grid, 3), picture, {}, shrunk, shrunk, cv::INTER_AREA);
    const ClassImage read = classify(to_rgb(picture), {});
    EXPECT_EQ(read.refusal, "");
    // Walls of the map as they lie in the picture, and a cell around.
    std::size_t walls = 0, astray = 0;
    for (int y = 0; y < picture.rows; ++y)
      for (int x = 0; x < picture.cols; ++x) {
        if (read.classes[{x, y}] != Occupancy::Occupied) continue;
        const double at_x = (x / shrunk - kWindow) / 3.0, at_y = (y / shrunk - kWindow) / 3.0;
        if (at_x < 0.0 || at_y < 0.0 || at_x >= grid.width() || at_y >= grid.height()) continue;  // the window's own
        ++walls;
        bool near = false;
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) {
            const int column = static_cast<int>(at_x) + dx;
            const int row = static_cast<int>(at_y) + dy;
            if (column >= 0 && row >= 0 && column < grid.width() && row < grid.height())
              near = near || grid[{column, row}] == Occupancy::Occupied;
          }
        if (!near) ++astray;
      }
    EXPECT_GE(walls, 1000u);
    EXPECT_LE(astray, walls / 50);
  }
}

}  // namespace
}  // namespace rubble::scoring
