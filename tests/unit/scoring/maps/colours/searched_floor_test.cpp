#include "scoring/maps/colours/searched_floor.h"

#include <gtest/gtest.h>

#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "scoring/maps/colours/league_colours.h"
#include "tests/support/map_pictures.h"
#include "tests/support/scoring_grounds.h"

namespace rubble::scoring {
namespace {

using namespace testing;

struct Change {
  std::string name;
  std::function<cv::Mat(const cv::Mat&)> of;
};

Change jpeg(int quality) {
  return {"JPEG of quality " + std::to_string(quality), [quality](const cv::Mat& picture) {
            std::vector<unsigned char> bytes;
            cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
            return cv::imdecode(bytes, cv::IMREAD_COLOR);
          }};
}

std::vector<Change> changes() {
  std::vector<Change> out = {jpeg(95), jpeg(75), jpeg(50), jpeg(35)};
  out.push_back({"blurred", [](const cv::Mat& picture) {
                   cv::Mat blurred;
                   cv::GaussianBlur(picture, blurred, {}, 1.0);
                   return blurred;
                 }});
  out.push_back(
      {"turned", [](const cv::Mat& picture) {
         const cv::Point2d middle(0.5 * picture.cols, 0.5 * picture.rows);
         const cv::Mat turn = cv::getRotationMatrix2D(cv::Point2f(middle), 8.0, 1.0);
         cv::Mat turned;
         cv::warpAffine(picture, turned, turn, picture.size(), cv::INTER_CUBIC, cv::BORDER_CONSTANT, {227, 226, 226});
         return turned;
       }});
  out.push_back({"smaller", [](const cv::Mat& picture) {
                   cv::Mat smaller;
                   cv::resize(picture, smaller, {}, 0.8, 0.8, cv::INTER_AREA);
                   return smaller;
                 }});
  out.push_back({"a coarse one of a fine one", [](const cv::Mat& picture) {
                   cv::Mat fine, coarse;
                   cv::resize(picture, fine, {}, 2.0, 2.0, cv::INTER_NEAREST);
                   cv::copyMakeBorder(fine, fine, 1, 1, 1, 1, cv::BORDER_CONSTANT, {227, 226, 226});
                   cv::resize(fine, coarse, {}, 0.5, 0.5, cv::INTER_AREA);
                   return coarse;
                 }});
  return out;
}

// The same map with white floor is the oracle.
TEST(SearchedFloor, IsReadAsOtherFreeFloorHoweverThePictureWasStored) {
  for (const std::uint64_t seed : {5u, 6u}) {
    const cv::Mat white = league_image(truth_of({"maze", 7, 5, seed}), false);
    const cv::Mat green = with_searched_floor(white);
    ASSERT_EQ(cv::countNonZero(classify_league(to_rgb(white)).classes != classify_league(to_rgb(green)).classes), 0);
    for (const Change& change : changes()) {
      SCOPED_TRACE(change.name + ", seed " + std::to_string(seed));
      const cv::Mat of_white = classify_league(to_rgb(change.of(white))).classes;
      const cv::Mat of_green = classify_league(to_rgb(change.of(green))).classes;
      constexpr int kWall = 2;
      const cv::Mat walls = (of_white == kWall) | (of_green == kWall);
      const cv::Mat differ = of_white != of_green;
      EXPECT_LE(cv::countNonZero(differ & walls), 0.06 * cv::countNonZero(walls));
      EXPECT_LE(cv::countNonZero(differ & ~walls), 0.01 * static_cast<double>(of_white.total()));
    }
  }
}

TEST(SearchedFloor, PicturesWithoutItStayAsTheyAre) {
  const RgbImage plain = to_rgb(league_image(truth_of({"maze", 7, 5, 5}), true));
  EXPECT_EQ(without_searched_floor(plain).rgb, plain.rgb);
}

}  // namespace
}  // namespace rubble::scoring
