#include "scoring/maps/colours/cell_lattice.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <opencv2/imgproc.hpp>

namespace rubble::scoring {
namespace {

cv::Mat walls_at_random(std::uint64_t seed) {
  cv::Mat out(80, 90, CV_8U);
  cv::RNG random(seed);
  random.fill(out, cv::RNG::UNIFORM, 0, 2);
  return out * 255;
}

cv::Mat shown(const cv::Mat& walls, int pixels, int left, int top) {
  cv::Mat out;
  cv::resize(walls, out, {}, pixels, pixels, cv::INTER_NEAREST);
  cv::copyMakeBorder(out, out, top, 5, left, 3, cv::BORDER_CONSTANT, cv::Scalar(0));
  return out;
}

TEST(CellLattice, IsFoundWithItsStartAndWhatIsOffItIsCounted) {
  for (const std::uint64_t seed : {1U, 2U, 3U})
    for (const int pixels : {2, 3, 5, 8}) {
      SCOPED_TRACE(::testing::Message() << "seed " << seed << ", " << pixels << " pixels");
      cv::Mat picture = shown(walls_at_random(seed), pixels, 7, 4);
      const CellLattice lattice = cell_lattice(picture);
      EXPECT_EQ(lattice.pixels, pixels);
      EXPECT_TRUE(lattice.has_column(7));
      EXPECT_TRUE(lattice.has_row(4));
      EXPECT_EQ(cv::countNonZero(edges_off(lattice, picture)), 0);
      cv::line(picture, {20, 30}, {60, 50}, cv::Scalar(255), 1);
      EXPECT_EQ(cell_lattice(picture).pixels, pixels);
      EXPECT_GT(cv::countNonZero(edges_off(lattice, picture)), 5);
    }
}

TEST(CellLattice, APictureOfACellAPixelHasNone) {
  for (const std::uint64_t seed : {4U, 5U, 6U}) {
    const cv::Mat walls = walls_at_random(seed);
    EXPECT_EQ(cell_lattice(walls).pixels, 1) << seed;
    EXPECT_EQ(cv::countNonZero(edges_off(cell_lattice(walls), walls)), 0) << seed;
  }
  EXPECT_EQ(cell_lattice(cv::Mat::zeros(20, 20, CV_8U)).pixels, 1);
}

/// Straight walls two cells wide lie on every second cell as well; walls aslant do not.
TEST(CellLattice, TheCellsOwnIsTakenWhereWallsAslantTellIt) {
  cv::Mat walls = cv::Mat::zeros(120, 120, CV_8U);
  for (int i = 10; i < 110; i += 20) cv::rectangle(walls, {i, 10}, {i + 1, 109}, cv::Scalar(255), cv::FILLED);
  for (int i = 10; i < 110; i += 20) cv::rectangle(walls, {10, i}, {109, i + 1}, cv::Scalar(255), cv::FILLED);
  EXPECT_EQ(cell_lattice(shown(walls, 2, 0, 0)).pixels, 4);
  cv::line(walls, {15, 15}, {75, 40}, cv::Scalar(255), 2);
  EXPECT_EQ(cell_lattice(shown(walls, 2, 0, 0)).pixels, 2);
}

}  // namespace
}  // namespace rubble::scoring
