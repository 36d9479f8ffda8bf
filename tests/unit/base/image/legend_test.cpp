#include "base/image/legend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "base/round_step.h"

namespace rubble {
namespace {

TEST(RoundStep, IsTheLeastOfOneTwoAndFiveTimesAPowerOfTen) {
  std::mt19937 random(20261127);
  for (int i = 0; i < 500; ++i) {
    const double least = std::pow(10.0, std::uniform_real_distribution<>(-6.0, 6.0)(random));
    const double step = round_step(least);
    SCOPED_TRACE(least);
    EXPECT_GE(step, least);
    EXPECT_LT(step, 2.5 * least * (1.0 + 1e-9));
    const double lead = step / std::pow(10.0, std::floor(std::log10(step * (1.0 + 1e-9))));
    EXPECT_LT(std::min({std::abs(lead - 1.0), std::abs(lead - 2.0), std::abs(lead - 5.0)}), 1e-6);
  }
  for (const double round : {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0}) EXPECT_DOUBLE_EQ(round_step(round), round);
}

constexpr int kDark = 100;

/// Places along a line of the picture that are ink.
template <class PixelAt>
std::vector<int> ink(int from, int to, const PixelAt& pixel_at) {
  std::vector<int> out;
  for (int i = from; i < to; ++i) {
    const cv::Vec3b c = pixel_at(i);
    if (c[0] < kDark && c[1] < kDark && c[2] < kDark) out.push_back(i);
  }
  return out;
}

cv::Mat blank(const GridFrame& frame, int scale) {
  return {frame.height * scale, frame.width * scale, CV_8UC3, cv::Scalar(206, 206, 206)};
}

/// A tick lies where the place of that many metres was drawn, whatever the map's corner and size.
TEST(Legend, TicksOfTheAxesStandAtWholeStepsOfTheMap) {
  const std::vector<GridFrame> frames = {{200, 200, 0.05, -2.0, -9.5},
                                         {150, 260, 0.05, 0.013, -3.37},
                                         {40, 30, 0.02, 5.0, 5.0},
                                         {2900, 900, 0.1, 451000.0, 5500007.0}};
  for (const GridFrame& frame : frames) {
    SCOPED_TRACE(frame.x0);
    const int scale = pixels_per_cell(frame);
    const double pixel = frame.resolution / scale;
    cv::Mat picture = blank(frame, scale);
    const cv::Size before = picture.size();
    put_axes(picture, frame, scale);
    const int left = picture.cols - before.width;
    ASSERT_GT(left, 10);
    ASSERT_GT(picture.rows, before.height + 10);
    const auto east = ink(left, picture.cols, [&](int x) { return picture.at<cv::Vec3b>(before.height + 2, x); });
    const auto north = ink(0, before.height, [&](int y) { return picture.at<cv::Vec3b>(y, left - 2); });
    const double step = round_step(60.0 * pixel);
    const auto off = [&](double metres) { return std::abs(metres / step - std::round(metres / step)) * step; };
    for (const int x : east) EXPECT_LE(off(frame.x0 + (x - left) * pixel), 0.51 * pixel);
    for (const int y : north) EXPECT_LE(off(frame.y0 + (before.height - y) * pixel), 1.01 * pixel);
    EXPECT_NEAR(static_cast<double>(east.size()), before.width * pixel / step, 1.01);
    EXPECT_NEAR(static_cast<double>(north.size()), before.height * pixel / step, 1.01);
  }
}

TEST(Legend, TheScaleBarIsAsLongAsItSays) {
  for (const double resolution : {0.02, 0.05, 0.1, 1.0}) {
    const GridFrame frame{300, 300, resolution, 0.0, 0.0};
    const int scale = pixels_per_cell(frame);
    cv::Mat picture = blank(frame, scale);
    const int rows = picture.rows;
    draw_legend(picture, {{kInkBgr, "wall"}}, frame, scale);
    int longest = 0;  // run of ink in the legend: the bar
    for (int y = rows; y < picture.rows; ++y) {
      const auto columns = ink(0, picture.cols, [&](int x) { return picture.at<cv::Vec3b>(y, x); });
      for (std::size_t begin = 0, i = 0; i < columns.size(); ++i) {
        if (i > 0 && columns[i] != columns[i - 1] + 1) begin = i;
        longest = std::max(longest, static_cast<int>(i - begin));
      }
    }
    const double metres = longest * resolution / scale;
    EXPECT_NEAR(round_step(0.99 * metres), metres, resolution / scale) << resolution;
  }
}

/// However narrow the picture, each word of the legend is whole: it takes the rows it needs.
TEST(Legend, TakesAsManyRowsAsItNeeds) {
  const GridFrame frame{30, 30, 0.05, 0.0, 0.0};
  const std::vector<LegendEntry> entries(4, LegendEntry(kInkBgr, "of the map alone"));
  cv::Mat narrow(100, kLeastWidth, CV_8UC3, cv::Scalar(206, 206, 206));
  cv::Mat wide(100, 3 * kLeastWidth, CV_8UC3, cv::Scalar(206, 206, 206));
  draw_legend(narrow, entries, frame, 12);
  draw_legend(wide, entries, frame, 12);
  EXPECT_GT(narrow.rows, wide.rows);
  EXPECT_EQ(narrow.cols, kLeastWidth);
  for (int y = 100; y < narrow.rows; ++y)
    EXPECT_EQ(narrow.at<cv::Vec3b>(y, narrow.cols - 1), cv::Vec3b(250, 250, 250)) << "cut off in row " << y;
}

}  // namespace
}  // namespace rubble
