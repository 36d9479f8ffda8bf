#include "scoring/maps/colours/canvas_corners.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "base/grid.h"

namespace rubble::scoring {
namespace {

constexpr int kSide = 200;
constexpr int kCorner = 60;
constexpr int kWallWidth = 4;  ///< thickness [pixels]

unsigned char value(Occupancy what) { return static_cast<unsigned char>(what); }

/// A map whose free space and wall reach the image's edges, with one black corner beyond the unknown around it.
cv::Mat turned_map() {
  cv::Mat classes(kSide, kSide, CV_8U, cv::Scalar(value(Occupancy::Unknown)));
  classes.rowRange(kSide / 2, kSide).setTo(value(Occupancy::Free));
  classes.rowRange(kSide / 2 - kWallWidth, kSide / 2).setTo(value(Occupancy::Occupied));
  for (int y = 0; y < kCorner; ++y) classes.row(y).colRange(0, kCorner - y).setTo(value(Occupancy::Occupied));
  return classes;
}

TEST(CanvasCorners, AreClearedAlsoWhereTheMapReachesTheEdges) {
  cv::Mat classes = turned_map();
  clear_canvas_corners(classes);
  EXPECT_EQ(cv::countNonZero(classes.rowRange(0, kSide / 2 - kWallWidth) == value(Occupancy::Occupied)), 0);
}

TEST(CanvasCorners, LeaveTheMapAsItIs) {
  cv::Mat classes = turned_map();
  clear_canvas_corners(classes);
  EXPECT_EQ(cv::countNonZero(classes == value(Occupancy::Free)), kSide * kSide / 2);
  EXPECT_EQ(cv::countNonZero(classes == value(Occupancy::Occupied)), kSide * kWallWidth);
}

/// A grey map turned on a canvas of one grey: nothing of the map is lost, whatever the grey is.
TEST(CanvasCorners, OfAGreyPictureAreFoundWhateverTheirGrey) {
  for (const int canvas : {0, 90, 255}) {
    cv::Mat map(kSide, kSide, CV_8U, cv::Scalar(205));
    cv::rectangle(map, {40, 40}, {160, 160}, cv::Scalar(254), cv::FILLED);
    cv::rectangle(map, {40, 40}, {160, 160}, cv::Scalar(0), 2);
    cv::line(map, {100, 40}, {100, 120}, cv::Scalar(0), 2);
    const cv::Mat turn = cv::getRotationMatrix2D(cv::Point2d(kSide / 2, kSide / 2), 20.0, 0.7);
    cv::Mat turned, inside;
    cv::warpAffine(map, turned, turn, map.size(), cv::INTER_NEAREST, cv::BORDER_CONSTANT, cv::Scalar(canvas));
    cv::warpAffine(cv::Mat(map.size(), CV_8U, cv::Scalar(255)), inside, turn, map.size(), cv::INTER_NEAREST);
    const cv::Mat found = canvas_corners(turned);
    EXPECT_EQ(cv::countNonZero(~inside & ~found), 0) << canvas;
    EXPECT_EQ(cv::countNonZero(found & (turned == 254)), 0) << canvas;
    EXPECT_LT(cv::countNonZero(found & inside), 0.1 * cv::countNonZero(inside)) << canvas;
  }
}

/// Ground in the walls' own grey reaches the corners as well, but the walls hang on to it.
TEST(CanvasCorners, AreNotTheBlackGroundAroundABuilding) {
  cv::Mat plan(kSide, kSide, CV_8U, cv::Scalar(0));
  cv::rectangle(plan, {30, 30}, {170, 100}, cv::Scalar(254), cv::FILLED);
  cv::rectangle(plan, {30, 101}, {90, 170}, cv::Scalar(254), cv::FILLED);
  for (const int x : {60, 90, 120}) cv::line(plan, {x, 30}, {x, 90}, cv::Scalar(0), 2);
  EXPECT_EQ(cv::countNonZero(canvas_corners(plan)), 0);
  cv::Mat room(kSide, kSide, CV_8U, cv::Scalar(0));
  cv::rectangle(room, {30, 30}, {170, 170}, cv::Scalar(254), cv::FILLED);
  EXPECT_EQ(cv::countNonZero(canvas_corners(room)), 0);
}

}  // namespace
}  // namespace rubble::scoring
