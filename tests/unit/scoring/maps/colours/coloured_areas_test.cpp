#include "scoring/maps/colours/coloured_areas.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/map_styles.h"
#include "tests/support/scoring_grounds.h"

namespace rubble::scoring {
namespace {

using namespace testing;

std::optional<GreyedAreas> read_areas(const cv::Mat& picture) {
  return greys_of_coloured_areas(to_rgb(picture), cv::Mat::zeros(picture.size(), CV_8U));
}

const std::vector<Colour> kRooms{{200, 220, 255}, {190, 255, 190}, {255, 210, 190}};

TEST(ColouredAreas, AreFreeAndWallsAndUnknownGroundStay) {
  const OccupancyGrid map = truth_of({"maze", 4, 4, 6});
  for (const int unknown : {255, 205, 90}) {
    const cv::Mat picture = with_rooms(map, kRooms, 2.0, kBlack, grey(unknown));
    const std::optional<GreyedAreas> read = read_areas(picture);
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(cv::countNonZero(read->grey != grey_image(map, 0, 128, 255)), 0);
  }
}

TEST(ColouredAreas, ThePageAroundIsUnknown) {
  const OccupancyGrid map = truth_of({"maze", 4, 4, 6});
  const cv::Mat picture = with_rooms(padded(map, 12), kRooms, 2.0, kBlack, grey(205));
  const Styled page = framed(picture, 1.0, 20, 20, 20, 20, kWhite);
  const std::optional<GreyedAreas> read = read_areas(page.image);
  ASSERT_TRUE(read.has_value());
  const cv::Mat inner = read->grey(cv::Rect(32, 32, map.width(), map.height()));
  EXPECT_EQ(cv::countNonZero(inner != grey_image(map, 0, 128, 255)), 0);
  EXPECT_EQ(read->grey.at<unsigned char>(5, 5), 128);
}

TEST(ColouredAreas, GreysWaysAndRoomsWithoutWallsAreNone) {
  const OccupancyGrid map = truth_of({"maze", 4, 4, 6});
  cv::Mat way = in_ros_greys(map, 2);
  EXPECT_FALSE(read_areas(way).has_value());
  cv::line(way, {0, 0}, {way.cols, way.rows}, {0, 0, 255}, 4);
  EXPECT_FALSE(read_areas(way).has_value());
  OccupancyGrid floor = map;
  std::replace(floor.cells().begin(), floor.cells().end(), Occupancy::Occupied, Occupancy::Free);
  EXPECT_FALSE(read_areas(with_rooms(floor, kRooms, 2.0, kBlack, kWhite)).has_value());
}

/// Three floors, each with every other dot of every other row in the next one's colour: no ground is broad anywhere.
TEST(ColouredAreas, FloorsThatAreDotsAllOverAreNone) {
  cv::Mat picture(300, 300, CV_8UC3, cv::Scalar(0, 0, 0));
  const std::vector<cv::Vec3b> floors{{255, 200, 120}, {120, 255, 120}, {120, 160, 255}};
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) {
      if (x % 100 < 3 || y % 100 < 3) continue;
      const auto floor = static_cast<std::size_t>(x / 100);
      picture.at<cv::Vec3b>(y, x) = floors[(floor + (x % 2 == 0 && y % 2 == 0 ? 1 : 0)) % 3];
    }
  EXPECT_FALSE(read_areas(picture).has_value());
}

}  // namespace
}  // namespace rubble::scoring
