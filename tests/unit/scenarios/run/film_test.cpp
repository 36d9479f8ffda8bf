#include "scenarios/run/film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "base/image/png.h"

namespace rubble::scenarios {
namespace {

/// Free ground of 6 x 3 m with its lower left corner at (-2, -1) m, a wall along its upper side.
FilmFrame frame_of_room(double wall_from) {
  FilmFrame frame;
  OccupancyGrid map(GridFrame{120, 60, 0.05, -2.0, -1.0}, Occupancy::Free);
  for (int x = 0; x < 120; ++x)
    if (map.centre({x, 59}).x > wall_from) map[{x, 59}] = Occupancy::Occupied;
  frame.map = map;
  frame.pose = {0.0, 0.0, 0.0};
  return frame;
}

bool is_near(const cv::Vec3b& pixel, int blue, int green, int red) {
  return std::abs(pixel[0] - blue) < 40 && std::abs(pixel[1] - green) < 40 && std::abs(pixel[2] - red) < 40;
}

int count_of(const cv::Mat& picture, int blue, int green, int red) {
  int n = 0;
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) n += is_near(picture.at<cv::Vec3b>(y, x), blue, green, red) ? 1 : 0;
  return n;
}

/// Mean place of the pixels of a colour.
cv::Point2d middle_of_colour(const cv::Mat& picture, int blue, int green, int red) {
  cv::Point2d sum(0.0, 0.0);
  double n = 0.0;
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      if (is_near(picture.at<cv::Vec3b>(y, x), blue, green, red)) {
        sum += cv::Point2d(x, y);
        n += 1.0;
      }
  return {sum.x / n, sum.y / n};
}

TEST(Film, APanelShowsThePlacesWhereTheyAre) {
  FilmFrame frame = frame_of_room(-9.0);
  frame.victims = {{3.0, 1.0}};
  const cv::Mat strip = film_strip({frame});
  const cv::Point2d robot = middle_of_colour(strip, 0, 130, 255), victim = middle_of_colour(strip, 10, 10, 240),
                    wall = middle_of_colour(strip, 120, 40, 0);
  const double pixels_per_metre = (victim.x - robot.x) / 3.0;
  EXPECT_GT(pixels_per_metre, 30.0);
  EXPECT_NEAR((robot.y - victim.y) / pixels_per_metre, 1.0, 0.1) << "up is where the map's y grows";
  EXPECT_NEAR((robot.y - wall.y) / pixels_per_metre, 1.975, 0.1);
  EXPECT_NEAR((wall.x - robot.x) / pixels_per_metre, 1.0, 0.1);
}

TEST(Film, AllPanelsShowTheSameGroundAndStandInRows) {
  FilmFrame early = frame_of_room(2.0);
  OccupancyGrid known = early.map.unpacked();
  for (int y = 0; y < 60; ++y)  // the left half is all that is known
    for (int x = 60; x < 120; ++x) known[{x, y}] = Occupancy::Unknown;
  early.map = known;
  const FilmFrame late = frame_of_room(2.0);
  const cv::Mat one = film_strip({late}), two = film_strip({early, late}),
                five = film_strip({early, early, early, late, late});
  EXPECT_GT(two.cols, 1.9 * one.cols - 30);
  EXPECT_EQ(two.rows, one.rows);
  EXPECT_GT(five.rows, 1.9 * one.rows - 30);
  EXPECT_GT(five.cols, two.cols);
  const cv::Mat left = two.colRange(0, two.cols / 2), right = two.colRange(two.cols / 2, two.cols);
  EXPECT_EQ(count_of(left, 120, 40, 0), 0) << "that wall is not known yet";
  EXPECT_GT(count_of(right, 120, 40, 0), 50);
  const double between = middle_of_colour(right, 0, 130, 255).x - middle_of_colour(left, 0, 130, 255).x;
  EXPECT_NEAR(between, 0.0, 12.0) << "the robot stands at the same place of both panels";
}

TEST(Film, ALegendNamesTheColoursBelowAllPanels) {
  FilmFrame frame = frame_of_room(-9.0);
  const cv::Mat strip = film_strip({frame}), whole = film_picture({frame});
  ASSERT_GT(whole.rows, strip.rows + 20);
  EXPECT_EQ(cv::norm(whole(cv::Rect({}, strip.size())), strip, cv::NORM_INF), 0.0) << "it hides nothing";
  const cv::Mat legend = whole.rowRange(strip.rows, whole.rows);
  for (const cv::Vec3b& colour : {cv::Vec3b(120, 40, 0), cv::Vec3b(180, 230, 180), cv::Vec3b(140, 0, 120),
                                  cv::Vec3b(60, 160, 0), cv::Vec3b(0, 130, 255), cv::Vec3b(10, 10, 240)}) {
    cv::Mat there;
    cv::inRange(legend, colour, colour, there);
    EXPECT_GT(cv::countNonZero(there), 50) << colour;
  }
  EXPECT_TRUE(film_picture({}).empty());
}

TEST(Film, SearchedFloorIsGreenButItsWallsAreNot) {
  FilmFrame frame = frame_of_room(-9.0);
  OccupancyGrid searched(frame.map.frame());
  for (int y = 0; y < 60; ++y)  // the right half
    for (int x = 60; x < 120; ++x) searched[{x, y}] = Occupancy::Occupied;
  const cv::Mat before = film_strip({frame});
  frame.searched = searched;
  const cv::Mat strip = film_strip({frame});
  const cv::Vec3b green(180, 230, 180);
  int greens = 0, whites = 0, walls = 0;
  for (int y = 0; y < strip.rows; ++y)
    for (int x = 0; x < strip.cols; ++x) {
      if (strip.at<cv::Vec3b>(y, x) == green) ++greens;
      whites += before.at<cv::Vec3b>(y, x) == cv::Vec3b(255, 255, 255) && strip.at<cv::Vec3b>(y, x) == green ? 1 : 0;
      walls += strip.at<cv::Vec3b>(y, x) == cv::Vec3b(120, 40, 0) ? 1 : 0;
    }
  const double pixels_per_metre = 360.0 / 6.6;
  EXPECT_NEAR(greens, 3.0 * 3.0 * pixels_per_metre * pixels_per_metre, 0.05 * greens) << "the right half";
  EXPECT_EQ(greens, whites) << "it was free ground before";
  EXPECT_EQ(walls, count_of(before, 120, 40, 0));
}

TEST(Film, NoGapsAreBetweenCells) {
  for (int width = 150; width < 330; width += 7) {
    FilmFrame frame;
    const OccupancyGrid map(GridFrame{width, 3 * width / 4, 0.05, -0.05 * (width / 3), -1.35}, Occupancy::Free);
    frame.map = map;
    frame.pose = {0.0, 0.0, 0.0};
    const cv::Mat strip = film_strip({frame});
    cv::Mat grey, ground;
    cv::inRange(strip, cv::Scalar(220, 220, 220), cv::Scalar(232, 232, 232), grey);
    cv::morphologyEx(grey, ground, cv::MORPH_OPEN, cv::Mat::ones(3, 3, CV_8U));  // unknown ground around, and no gap
    ASSERT_GT(cv::countNonZero(ground), 1000) << width;
    grey.setTo(0, ground);
    EXPECT_EQ(cv::countNonZero(grey(cv::boundingRect(ground))), 0) << width;  // the words below are grey, too
  }
}

TEST(Film, AMomentWithoutAMapAndNoMomentAtAll) {
  FilmFrame nothing;
  nothing.map = OccupancyGrid(GridFrame{0, 0, 0.05, 0.0, 0.0}, Occupancy::Unknown);
  EXPECT_TRUE(film_strip({}).empty());
  EXPECT_GT(film_strip({nothing}).cols, 100);
  EXPECT_EQ(png_bytes(film_strip({nothing, frame_of_room(0.0)})), png_bytes(film_strip({nothing, frame_of_room(0.0)})));
}

}  // namespace
}  // namespace rubble::scenarios
