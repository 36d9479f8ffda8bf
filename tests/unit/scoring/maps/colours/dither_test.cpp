#include "scoring/maps/colours/dither.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tests/support/map_styles.h"
#include "tests/support/scoring_grounds.h"

namespace rubble::scoring {
namespace {

using namespace testing;

cv::Mat grey_of_styled(const cv::Mat& picture) {
  cv::Mat out;
  cv::cvtColor(picture, out, cv::COLOR_BGR2GRAY);
  return out;
}

TEST(Dither, IsUndoneUpToAFewPixelsBesideWalls) {
  const cv::Mat picture = in_ros_greys(truth_of({"maze", 4, 4, 6}), 2), grey = grey_of_styled(picture);
  for (const cv::Mat& dithered : {diffused(picture, nearest_level(2)), ordered(picture, 4), ordered(picture, 8)}) {
    const std::optional<Undithered> read = without_dither(grey_of_styled(dithered));
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->lost, "");
    const cv::Mat off = cv::abs(read->grey - grey) > 12;
    EXPECT_LE(cv::countNonZero(off), 0.02 * static_cast<double>(grey.total()));
    EXPECT_LE(cv::countNonZero((read->grey == 0) != (grey == 0)), 0.05 * cv::countNonZero(grey == 0));
  }
}

TEST(Dither, GroundsThatAreTooMuchAlikeAreSaid) {
  const cv::Mat picture = in_colours(truth_of({"maze", 4, 4, 6}), kBlack, grey(228), grey(244), 2);
  const std::optional<Undithered> read = without_dither(grey_of_styled(diffused(picture, nearest_level(2))));
  ASSERT_TRUE(read.has_value());
  EXPECT_NE(read->lost, "");
}

TEST(Dither, PlainAndSaltedPicturesHaveNone) {
  const OccupancyGrid map = truth_of({"maze", 4, 4, 6});
  EXPECT_FALSE(without_dither(grey_of_styled(in_ros_greys(map, 2))).has_value());
  for (const double share : {0.03, 0.1, 0.3})
    EXPECT_FALSE(without_dither(grey_of_styled(in_ros_greys(with_salt(map, share, 3)))).has_value()) << share;
}

}  // namespace
}  // namespace rubble::scoring
