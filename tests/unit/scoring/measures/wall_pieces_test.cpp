#include "scoring/measures/wall_pieces.h"

#include <gtest/gtest.h>

namespace rubble::scoring {
namespace {

TEST(WallPieces, AStepOverACornerSlipsBetweenTheTwoCellsBesideIt) {
  WallPieces pieces;
  pieces.strength = Grid<float>(GridFrame{3, 2, 0.05, 0.0, 0.0});
  pieces.strength[{1, 0}] = 0.25f;
  pieces.strength[{0, 1}] = 0.75f;
  EXPECT_EQ(pieces.between({0, 0}, {1, 1}), 0.25);
  EXPECT_EQ(pieces.between({1, 1}, {0, 0}), 0.25);
  EXPECT_EQ(pieces.between({0, 0}, {1, 0}), 0.0) << "over an edge";
}

/// Lines of sight are moved over the map until both fit: some end outside.
TEST(WallPieces, AStepOutOfTheGridSlipsThroughNothing) {
  WallPieces pieces;
  pieces.strength = Grid<float>(GridFrame{3, 2, 0.05, 0.0, 0.0}, 1.0f);
  for (const Cell outside : {Cell{3, 1}, Cell{3, -1}}) {
    EXPECT_EQ(pieces.between({2, 0}, outside), 0.0) << outside.x << ", " << outside.y;
    EXPECT_EQ(pieces.between(outside, {2, 0}), 0.0) << outside.x << ", " << outside.y;
  }
  EXPECT_EQ(pieces.between({1, 1}, {2, 2}), 0.0);
}

}  // namespace
}  // namespace rubble::scoring
