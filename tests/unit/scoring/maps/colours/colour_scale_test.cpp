#include "scoring/maps/colours/colour_scale.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "scoring/maps/colours/map_colours.h"
#include "tests/support/map_pictures.h"
#include "tests/support/scoring_grounds.h"

namespace rubble::scoring {
namespace {

using namespace testing;

RgbImage image_of(const cv::Mat& bgr) {
  RgbImage out(bgr.cols, bgr.rows);
  for (int y = 0; y < bgr.rows; ++y)
    for (int x = 0; x < bgr.cols; ++x)
      for (int i = 0; i < 3; ++i) out.pixel(x, y)[i] = bgr.at<cv::Vec3b>(y, x)[2 - i];
  return out;
}

/// Probabilities of being occupied: walls 200 to 255, floor 0 to 60, unknown ground 128; each pixel its own.
cv::Mat probabilities(const OccupancyGrid& grid, int pixels) {
  cv::Mat out(grid.height() * pixels, grid.width() * pixels, CV_8U);
  cv::RNG random(5);
  for (int y = 0; y < out.rows; ++y)
    for (int x = 0; x < out.cols; ++x) {
      const Occupancy o = grid[{x / pixels, grid.height() - 1 - y / pixels}];
      const int value = o == Occupancy::Unknown    ? 128
                        : o == Occupancy::Occupied ? random.uniform(200, 256)
                                                   : random.uniform(0, 61);
      out.at<unsigned char>(y, x) = static_cast<unsigned char>(value);
    }
  return out;
}

const std::vector<cv::ColormapTypes> kDrawn{cv::COLORMAP_VIRIDIS, cv::COLORMAP_PLASMA, cv::COLORMAP_INFERNO,
                                            cv::COLORMAP_MAGMA,   cv::COLORMAP_JET,    cv::COLORMAP_TURBO,
                                            cv::COLORMAP_PARULA};

TEST(ColourScale, ItsValuesComeBack) {
  cv::Mat values(16, 256, CV_8U);
  for (int x = 0; x < values.cols; ++x) values.col(x) = cv::Scalar(x);
  for (const cv::ColormapTypes type : kDrawn) {
    cv::Mat drawn;
    cv::applyColorMap(values, drawn, type);
    const auto found = values_of_colour_scale(image_of(drawn));
    ASSERT_TRUE(found) << type;
    for (int x = 0; x < values.cols; ++x) EXPECT_NEAR(found->greys.pixel(x, 3)[0], x, 2) << found->name;
  }
}

/// Blue, cyan, yellow and red lie on jet's scale, but areas in four flat colours are no values of it.
TEST(ColourScale, FlatColoursAreNoValues) {
  const cv::Vec3b flat[] = {{255, 0, 0}, {255, 255, 0}, {0, 255, 255}, {0, 0, 255}};
  cv::Mat areas(64, 64, CV_8UC3);
  for (int y = 0; y < areas.rows; ++y)
    for (int x = 0; x < areas.cols; ++x) areas.at<cv::Vec3b>(y, x) = flat[x / 16];
  EXPECT_FALSE(values_of_colour_scale(image_of(areas)));
}

TEST(ColourScale, AMapOfProbabilitiesIsReadAsInGreys) {
  const OccupancyGrid map = padded(truth_of({"yellow", 5, 5, 71}), 12);
  for (const cv::ColormapTypes type : kDrawn)
    for (const bool occupied_is_high : {true, false}) {
      cv::Mat values = probabilities(map, 2), drawn;
      if (!occupied_is_high) values = 255 - values;
      cv::applyColorMap(values, drawn, type);
      const ClassImage read = classify(image_of(drawn));
      EXPECT_EQ(read.refusal, "") << type;
      EXPECT_NE(read.recognised.find("values of the colour scale"), std::string::npos) << read.recognised;
      int wrong = 0;
      for (int y = 0; y < read.classes.height(); ++y)
        for (int x = 0; x < read.classes.width(); ++x) wrong += read.classes[{x, y}] != map[{x / 2, y / 2}] ? 1 : 0;
      EXPECT_LT(wrong, static_cast<int>(read.classes.cells().size()) / 500) << type << ": " << read.recognised;
    }
}

TEST(ColourScale, OtherPicturesHaveNone) {
  const OccupancyGrid map = padded(truth_of({"yellow", 5, 5, 72}), 12);
  cv::Mat league = league_image(map, true), tinted;
  EXPECT_FALSE(values_of_colour_scale(image_of(league)));
  EXPECT_FALSE(values_of_colour_scale(image_of(with_searched_floor(league, 1.0))));
  cv::cvtColor(grey_image(map, 0, 205, 254), tinted, cv::COLOR_GRAY2BGR);
  EXPECT_FALSE(values_of_colour_scale(image_of(tinted)));
  for (int i = 0; i < 3; ++i) {  // sepia, and tints like it
    cv::Mat weights = (cv::Mat_<double>(1, 3) << 0.55 + 0.1 * i, 0.75, 0.95 - 0.1 * i), out;
    cv::multiply(tinted, cv::Scalar(weights.at<double>(0), weights.at<double>(1), weights.at<double>(2)), out);
    EXPECT_FALSE(values_of_colour_scale(image_of(out))) << i;
  }
}

}  // namespace
}  // namespace rubble::scoring
