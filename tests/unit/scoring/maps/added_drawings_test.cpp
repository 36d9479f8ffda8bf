#include "scoring/maps/colours/added_drawings.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <string>

#include "scoring/maps/colours/map_colours.h"
#include "tests/support/map_pictures.h"
#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;

RgbImage rgb_of(const cv::Mat& picture) {
  cv::Mat bgr = picture;
  if (bgr.channels() == 1) cv::cvtColor(picture, bgr, cv::COLOR_GRAY2BGR);
  RgbImage out(bgr.cols, bgr.rows);
  cv::cvtColor(bgr, cv::Mat(bgr.rows, bgr.cols, CV_8UC3, out.rgb.data()), cv::COLOR_BGR2RGB);
  return out;
}

/// A maze of which a quarter is unknown, in greys, with unknown ground around.
cv::Mat map_picture(int unknown) {
  OccupancyGrid grid = maze({5, 4, 1});
  for (int y = 0; y < grid.height() / 2; ++y)
    for (int x = 0; x < grid.width() / 2; ++x) grid[{x, y}] = Occupancy::Unknown;
  cv::Mat out;
  cv::copyMakeBorder(grey_image(grid, 0, unknown, 255), out, 12, 12, 12, 12, cv::BORDER_CONSTANT, cv::Scalar(unknown));
  return out;
}

/// A hall with three walls of 1.2 m, in greys.
cv::Mat hall_picture() {
  cv::Mat out(260, 260, CV_8U, cv::Scalar(205));
  cv::rectangle(out, {20, 20}, {239, 239}, cv::Scalar(0), cv::FILLED);
  cv::rectangle(out, {22, 22}, {237, 237}, cv::Scalar(254), cv::FILLED);
  for (const int x : {60, 120, 180}) cv::rectangle(out, {x, 190}, {x + 23, 191}, cv::Scalar(0), cv::FILLED);
  return out;
}

/// Cells of `picture` that are read otherwise than those of `map`, which lies in it at `corner` (from the upper left).
int read_otherwise(const cv::Mat& picture, const cv::Mat& map, cv::Point corner) {
  const ClassImage whole = classify(rgb_of(picture));
  const ClassImage alone = classify(rgb_of(map));
  int differ = 0;
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) {
      const cv::Point at = cv::Point(x, y) - corner;
      const bool within = at.x >= 0 && at.y >= 0 && at.x < map.cols && at.y < map.rows;
      const Occupancy expected = within ? alone.classes[{at.x, map.rows - 1 - at.y}] : Occupancy::Unknown;
      differ += whole.classes[{x, picture.rows - 1 - y}] != expected ? 1 : 0;
    }
  return differ;
}

TEST(AddedDrawings, MarginsAxesAndTitlesOfAPlotAreNoGround) {
  for (const int unknown : {128, 205}) {
    SCOPED_TRACE(unknown);
    const cv::Mat map = map_picture(unknown);
    cv::Mat plot, title, framed;
    cv::copyMakeBorder(map, plot, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
    cv::copyMakeBorder(plot, plot, 20, 24, 24, 20, cv::BORDER_CONSTANT, cv::Scalar(255));
    cv::putText(plot, "0 2 4 6 m", {30, plot.rows - 8}, cv::FONT_HERSHEY_PLAIN, 0.8, cv::Scalar(0));
    EXPECT_LE(read_otherwise(plot, map, {25, 21}), 2 * (map.cols + map.rows) + 4) << "the axes may stay";
    cv::copyMakeBorder(map, title, 30, 0, 0, 0, cv::BORDER_CONSTANT, cv::Scalar(255));
    cv::putText(title, "run 3", {15, 22}, cv::FONT_HERSHEY_PLAIN, 1.2, cv::Scalar(0));
    EXPECT_EQ(read_otherwise(title, map, {0, 30}), 0);
    cv::copyMakeBorder(map, framed, 20, 10, 10, 10, cv::BORDER_CONSTANT, cv::Scalar(255));
    cv::rectangle(framed, {4, 4}, {framed.cols - 5, framed.rows - 5}, cv::Scalar(0));
    EXPECT_EQ(read_otherwise(framed, map, {10, 20}), 0);
  }
}

TEST(AddedDrawings, FreeGroundThatReachesTheRimOfAMapStays) {
  cv::Mat map = map_picture(205);
  map.rowRange(0, 40).setTo(255);  // a hall above the maze, wider than the map and not parted from it by a rectangle
  map.colRange(map.cols - 20, map.cols).setTo(255);
  cv::Mat classes(map.size(), CV_8U, cv::Scalar(static_cast<int>(Occupancy::Free)));
  classes.setTo(static_cast<int>(Occupancy::Unknown), map == 205);
  classes.setTo(static_cast<int>(Occupancy::Occupied), map == 0);
  const cv::Mat before = classes.clone();
  EXPECT_FALSE(clear_around_panel(classes));
  EXPECT_FALSE(clear_around_league_map(classes));
  EXPECT_EQ(cv::countNonZero(classes != before), 0);
}

/// A page's legend in the walls' own blue, as large as a legend is: nothing of it is read as the map's.
TEST(AddedDrawings, ALegendBesideALeagueMapIsNoPartOfIt) {
  const cv::Mat map = league_image(padded(maze({5, 4, 1}), 12), false);
  cv::Mat page;
  cv::copyMakeBorder(map, page, 50, 50, 50, 60, cv::BORDER_CONSTANT, cv::Scalar::all(255));
  EXPECT_EQ(read_otherwise(page, map, {50, 50}), 0);
  const cv::Scalar blue(120, 40, 0);
  cv::Mat swatch = page.clone(), bar = page.clone();
  cv::rectangle(swatch, cv::Rect(page.cols - 40, 70, 21, 11), blue, cv::FILLED);
  EXPECT_EQ(read_otherwise(swatch, map, {50, 50}), 0);
  cv::rectangle(bar, cv::Rect(page.cols - 140, page.rows - 25, 61, 4), blue, cv::FILLED);
  EXPECT_EQ(read_otherwise(bar, map, {50, 50}), 0);
}

/// Free ground around an arena whose own walls bound it is the arena's surroundings, not a page.
TEST(AddedDrawings, FreeGroundAroundTheWallsOfALeagueMapStays) {
  cv::Mat classes(120, 160, CV_8U, cv::Scalar(static_cast<int>(Occupancy::Free)));
  const cv::Rect arena(20, 20, 120, 80);
  cv::rectangle(classes, arena, cv::Scalar(static_cast<int>(Occupancy::Occupied)), 2);
  classes(cv::Rect(60, 40, 40, 40)).setTo(static_cast<int>(Occupancy::Unknown));
  const cv::Mat before = classes.clone();
  EXPECT_FALSE(clear_around_league_map(classes));
  EXPECT_EQ(cv::countNonZero(classes != before), 0);
}

TEST(AddedDrawings, APanelTooSmallForAMapIsNone) {
  for (int height = 1; height < 40; ++height) {
    cv::Mat picture(44, 60, CV_8UC1, cv::Scalar(255));
    picture(cv::Rect(0, 2, 60, height)) = 0;
    EXPECT_NO_THROW(classify(rgb_of(picture))) << height << " rows";
  }
}

TEST(AddedDrawings, TheWayOfTheRobotInColourIsNoWall) {
  const cv::Mat map = map_picture(205);
  cv::Mat drawn;
  cv::cvtColor(map, drawn, cv::COLOR_GRAY2BGR);
  cv::line(drawn, {20, 20}, {map.cols - 30, 24}, cv::Scalar(0, 0, 255));
  cv::circle(drawn, {map.cols - 40, 40}, 4, cv::Scalar(0, 160, 0), -1);
  int walls_under = 0;
  for (int y = 0; y < map.rows; ++y)
    for (int x = 0; x < map.cols; ++x)
      if (map.at<unsigned char>(y, x) == 0 && drawn.at<cv::Vec3b>(y, x) != cv::Vec3b(0, 0, 0)) ++walls_under;
  // Ground that lies nearer to other ground over there than to its own is a matter of a few pixels.
  EXPECT_LE(read_otherwise(drawn, map, {0, 0}), walls_under + 12);
}

TEST(AddedDrawings, WallsInColourAreWalls) {
  const cv::Mat map = map_picture(205);
  cv::Mat red;
  cv::cvtColor(map, red, cv::COLOR_GRAY2BGR);
  red.setTo(cv::Scalar(0, 0, 200), map == 0);
  cv::Mat grey = map.clone();
  EXPECT_FALSE(paint_over_colours(rgb_of(red), cv::Mat::zeros(map.size(), CV_8U), grey));
  EXPECT_EQ(read_otherwise(red, map, {0, 0}), 0);
}

TEST(AddedDrawings, WallsInAllColoursOfARainbowAreWallsThroughJpegToo) {
  const cv::Mat map = map_picture(205);
  cv::Mat twice, hue(2 * map.rows, 2 * map.cols, CV_8U), rainbow, picture;
  cv::resize(map, twice, {}, 2, 2, cv::INTER_NEAREST);
  for (int x = 0; x < hue.cols; ++x) hue.col(x) = cv::Scalar(255.0 * x / hue.cols);
  cv::applyColorMap(hue, rainbow, cv::COLORMAP_JET);
  cv::cvtColor(twice, picture, cv::COLOR_GRAY2BGR);
  rainbow.copyTo(picture, twice == 0);
  EXPECT_LE(read_otherwise(picture, twice, {0, 0}), picture.rows * picture.cols / 1000);
  EXPECT_LE(read_otherwise(as_jpeg(picture, 85), twice, {0, 0}), picture.rows * picture.cols / 50);
}

/// A layer over another picture: free ground, or what nobody saw, lets that show through.
TEST(AddedDrawings, WhatIsTransparentWithinOneGroundIsFreeAndElsewhereUnknown) {
  const cv::Mat map = map_picture(205);
  const RgbImage opaque = rgb_of(map);
  const ClassImage expected = classify(opaque);
  for (const int transparent : {205, 255}) {
    RgbImage layer = opaque;
    layer.alpha.assign(map.total(), 255);
    for (std::size_t i = 0; i < map.total(); ++i)
      if (map.data[i] == transparent) {
        layer.alpha[i] = 0;
        for (std::size_t k = 0; k < 3; ++k) layer.rgb[3 * i + k] = 226;
      }
    const ClassImage read = classify(layer);
    EXPECT_EQ(read.classes.cells(), expected.classes.cells()) << transparent;
    EXPECT_EQ(read.recognised.find("what is transparent is ground") != std::string::npos, transparent == 255);
  }
}

/// Whatever grey the opaque ground has: also that in which transparent pixels are shown.
TEST(AddedDrawings, TheGroundAroundATransparentFloorMayHaveAnyGrey) {
  for (const int ground : {128, 205, 215, 222, 226, 230, 240, 250}) {
    const cv::Mat map = map_picture(ground);
    RgbImage layer = rgb_of(map);
    layer.alpha.assign(map.total(), 255);
    for (std::size_t i = 0; i < map.total(); ++i)
      if (map.data[i] == 255) {
        layer.alpha[i] = 0;
        for (std::size_t k = 0; k < 3; ++k) layer.rgb[3 * i + k] = 226;
      }
    const ClassImage read = classify(layer);
    EXPECT_EQ(read.refusal, "") << ground;
    int wrong = 0;
    for (int y = 0; y < map.rows; ++y)
      for (int x = 0; x < map.cols; ++x) {
        const int grey = map.at<unsigned char>(y, x);
        const Occupancy own = grey == 0 ? Occupancy::Occupied : grey == 255 ? Occupancy::Free : Occupancy::Unknown;
        wrong += read.classes[{x, map.rows - 1 - y}] != own ? 1 : 0;
      }
    EXPECT_EQ(wrong, 0) << ground << read.recognised;
  }
}

TEST(AddedDrawings, AGridOverTheGroundIsNoUnknownGround) {
  const cv::Mat map = map_picture(128);
  cv::Mat grid = map.clone();
  for (int x = 5; x < grid.cols; x += 20) grid.col(x).setTo(190, map.col(x) != 0);
  for (int y = 5; y < grid.rows; y += 20) grid.row(y).setTo(190, map.row(y) != 0);
  EXPECT_LE(read_otherwise(grid, map, {0, 0}), 20) << "where known ground ends at a line";
}

TEST(AddedDrawings, ANameInTheWallsOwnBlackIsNoWallAndTheProgramSaysSo) {
  for (const int pen : {cv::LINE_8, cv::LINE_AA}) {
    SCOPED_TRACE(pen);
    const cv::Mat map = hall_picture();
    cv::Mat named = map.clone();
    cv::putText(named, "TEAM 7", {60, 130}, cv::FONT_HERSHEY_SIMPLEX, 1.0, cv::Scalar(0), 1, pen);
    EXPECT_LE(read_otherwise(named, map, {0, 0}), 0);
    EXPECT_NE(classify(rgb_of(named)).recognised.find("words on free ground removed"), std::string::npos);
    EXPECT_EQ(classify(rgb_of(map)).recognised.find("words"), std::string::npos);
  }
}

}  // namespace
}  // namespace rubble::scoring
