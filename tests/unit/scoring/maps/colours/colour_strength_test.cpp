#include "scoring/maps/colours/colour_strength.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "scoring/maps/colours/map_colours.h"
#include "tests/support/map_pictures.h"
#include "tests/support/scoring_grounds.h"
#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;

/// As image editors do: away from the grey that is as bright.
cv::Mat with_stronger_colours(const cv::Mat& bgr, double by) {
  cv::Mat grey;
  cv::cvtColor(bgr, grey, cv::COLOR_BGR2GRAY);
  cv::cvtColor(grey, grey, cv::COLOR_GRAY2BGR);
  cv::Mat out;
  cv::addWeighted(bgr, by, grey, 1.0 - by, 0.0, out);
  return out;
}

/// Pixels of one class in one reading and of another in the other, walls aside by a pixel.
double differing(const cv::Mat& picture, const Grid<Occupancy>& expected) {
  const ClassImage read = classify(to_rgb(picture), {});
  EXPECT_EQ(read.refusal, "");
  std::size_t differ = 0;
  for (std::size_t i = 0; i < expected.cells().size(); ++i) differ += read.classes.cells()[i] != expected.cells()[i];
  return static_cast<double>(differ) / static_cast<double>(expected.cells().size());
}

TEST(ColourStrength, StrongerColoursAreTakenBack) {
  for (const double searched : {0.0, 0.5, 1.0}) {
    const cv::Mat map = with_searched_floor(league_image(padded(truth_of({"maze", 7, 5, 5}), 40), true), searched);
    const Grid<Occupancy> expected = classify(to_rgb(map), {}).classes;
    for (const double by : {1.2, 1.5, 1.8, 2.2}) {
      SCOPED_TRACE("searched " + std::to_string(searched) + ", " + std::to_string(by) + " times");
      const cv::Mat stronger = with_stronger_colours(map, by);
      EXPECT_NEAR(colour_strength(to_rgb(stronger)), by, 0.03);
      EXPECT_LE(differing(stronger, expected), 0.002);
    }
  }
}

TEST(ColourStrength, OfSearchedFloorAlsoThroughJpeg) {
  cv::Mat map;
  cv::resize(with_searched_floor(league_image(padded(truth_of({"maze", 7, 5, 5}), 40), true), 1.0), map, {}, 2.0, 2.0,
             cv::INTER_NEAREST);
  const auto as_jpeg_of = [](const cv::Mat& picture) {
    std::vector<unsigned char> bytes;
    cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, 80});
    return cv::imdecode(bytes, cv::IMREAD_COLOR);
  };
  EXPECT_EQ(colour_strength(to_rgb(as_jpeg_of(map))), 1.0);
  const Grid<Occupancy> expected = classify(to_rgb(map), {}).classes;
  for (const double by : {1.3, 1.8, 2.4}) {
    SCOPED_TRACE(by);
    const cv::Mat stronger = as_jpeg_of(with_stronger_colours(map, by));
    EXPECT_NEAR(colour_strength(to_rgb(stronger)), by, 0.15);
    EXPECT_LE(differing(stronger, expected), 0.02);
  }
}

TEST(ColourStrength, OtherPicturesHaveTheirOwn) {
  EXPECT_EQ(colour_strength(RgbImage()), 1.0);
  EXPECT_EQ(colour_strength(to_rgb(league_image(truth_of({"maze", 7, 5, 5}), true))), 1.0);
  cv::Mat grey;
  cv::cvtColor(grey_image(truth_of({"maze", 7, 5, 5}), 0, 205, 254), grey, cv::COLOR_GRAY2BGR);
  EXPECT_EQ(colour_strength(to_rgb(grey)), 1.0);
}

}  // namespace
}  // namespace rubble::scoring
