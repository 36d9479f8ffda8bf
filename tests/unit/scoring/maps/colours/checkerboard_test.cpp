#include "scoring/maps/colours/checkerboard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>

namespace rubble::scoring {
namespace {

constexpr Rgb kDarkSquare{200, 180, 160}, kLightSquare{215, 195, 170};

/// A board with squares of `side` pixels, the upper left one light.
RgbImage board_of(int columns, int rows, int side) {
  RgbImage image(columns * side, rows * side);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgb& ink = (x / side + y / side) % 2 == 0 ? kLightSquare : kDarkSquare;
      std::copy(ink.begin(), ink.end(), image.pixel(x, y));
    }
  return image;
}

double seconds_to_look_at(const RgbImage& image) {
  const std::clock_t start = std::clock();
  EXPECT_TRUE(find_checkerboard(image).is_there());
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

TEST(Checkerboard, EachInnerCornerOfABoardIsACrossing) {
  for (const int side : {8, 9}) {
    const Checkerboard board = find_checkerboard(board_of(7, 5, side));
    EXPECT_EQ(board.crossings, 24u) << side;
    EXPECT_EQ(board.darker, kDarkSquare) << side;
    EXPECT_EQ(board.lighter, kLightSquare) << side;
    EXPECT_EQ(board.unevenness, 0) << side;
  }
}

// Corners are looked for as if they were blended: at that of a large and sharp square more than one place is like it.
TEST(Checkerboard, CornersOfLargeSquaresAreNotMissed) {
  for (const int side : {14, 20, 33, 99}) {
    const Checkerboard board = find_checkerboard(board_of(7, 5, side));
    EXPECT_GE(board.crossings, 24u) << side;
    EXPECT_EQ(board.darker, kDarkSquare) << side;
    EXPECT_EQ(board.lighter, kLightSquare) << side;
  }
}

TEST(Checkerboard, LonelyCornersAreNone) {
  EXPECT_FALSE(find_checkerboard(board_of(2, 2, 40)).is_there());
  EXPECT_EQ(find_checkerboard(board_of(4, 4, 120)).crossings, 0u) << "no square is so large";
}

TEST(Checkerboard, NeighboursCountInRowsAndInColumns) {
  EXPECT_EQ(find_checkerboard(board_of(9, 2, 8)).crossings, 8u);
  EXPECT_EQ(find_checkerboard(board_of(2, 9, 8)).crossings, 8u);
}

// A picture of 10^8 pixels with small squares has a million corners: each looks at those beside it, not at whole rows.
TEST(Checkerboard, ManySmallSquaresTakeLittleMoreThanLargeOnes) {
  const double large = seconds_to_look_at(board_of(500, 4, 40));
  const double small = seconds_to_look_at(board_of(2500, 20, 8));
  EXPECT_LT(small, 8.0 * large) << large << " s for squares of 40 pixels";
}

}  // namespace
}  // namespace rubble::scoring
