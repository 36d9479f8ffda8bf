#include "scoring/maps/canvas_corners.h"

#include <gtest/gtest.h>

#include "base/grid.h"

namespace rubble::scoring {
namespace {

constexpr int kSide = 200;
constexpr int kCorner = 60;
constexpr int kWall = 4;  ///< thickness [pixels]

unsigned char value(Occupancy what) { return static_cast<unsigned char>(what); }

/// A map whose free space and wall reach the image's edges, with one black corner beyond the unknown around it.
cv::Mat turned_map() {
  cv::Mat classes(kSide, kSide, CV_8U, cv::Scalar(value(Occupancy::Unknown)));
  classes.rowRange(kSide / 2, kSide).setTo(value(Occupancy::Free));
  classes.rowRange(kSide / 2 - kWall, kSide / 2).setTo(value(Occupancy::Occupied));
  for (int y = 0; y < kCorner; ++y) classes.row(y).colRange(0, kCorner - y).setTo(value(Occupancy::Occupied));
  return classes;
}

TEST(CanvasCorners, AreClearedAlsoWhereTheMapReachesTheEdges) {
  cv::Mat classes = turned_map();
  clear_canvas_corners(classes);
  EXPECT_EQ(cv::countNonZero(classes.rowRange(0, kSide / 2 - kWall) == value(Occupancy::Occupied)), 0);
}

TEST(CanvasCorners, LeaveTheMapAsItIs) {
  cv::Mat classes = turned_map();
  clear_canvas_corners(classes);
  EXPECT_EQ(cv::countNonZero(classes == value(Occupancy::Free)), kSide * kSide / 2);
  EXPECT_EQ(cv::countNonZero(classes == value(Occupancy::Occupied)), kSide * kWall);
}

}  // namespace
}  // namespace rubble::scoring
