#include "explore/search/wall_holes.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <utility>

#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;

/// A floor of 3 x 3 m with a wall across its middle, from x = 0.5 to 2.5 m.
OccupancyGrid across(double resolution) {
  OccupancyGrid cells = test::room(3.0, 3.0, resolution);
  test::fill(cells, 0.5, 1.5, 2.5, 1.5 + resolution, Occupancy::Occupied);
  return cells;
}

Traversable opened(double from, double to, double resolution = 0.05) {
  OccupancyGrid cells = across(resolution);
  test::fill(cells, from, 1.5, to, 1.5 + resolution, Occupancy::Free);
  return test::measured(std::move(cells));
}

TEST(WallHoles, AreSeenInTheMiddleOfTheirGapsAtAnyResolution) {
  for (const double resolution : {0.05, 0.025}) {
    const auto holes = wall_holes(opened(1.4, 1.55, resolution));
    ASSERT_EQ(holes.size(), 1U) << resolution;
    EXPECT_NEAR(holes[0].p_map.x, 1.475, 0.5 * resolution + 1e-9);
    EXPECT_NEAR(holes[0].p_map.y, 1.5 + 0.5 * resolution, 1e-9);
    EXPECT_EQ(holes[0].along, (Cell{1, 0}));
  }
}

TEST(WallHoles, DoorsAndTheEndsOfWallsAreNone) {
  EXPECT_TRUE(wall_holes(opened(1.2, 1.2)).empty()) << "no gap";
  EXPECT_TRUE(wall_holes(opened(1.2, 1.6)).empty()) << "a door";
  EXPECT_TRUE(wall_holes(opened(0.6, 0.75)).empty()) << "beside what is no board";
}

TEST(WallHoles, AWallThatLiesAskewHasNone) {
  OccupancyGrid cells = test::room(3.0, 3.0);
  for (int i = 0; i < 4; ++i)
    test::fill(cells, 0.5 + 0.5 * i, 1.5 + 0.05 * i, 1.0 + 0.5 * i, 1.55 + 0.05 * i, Occupancy::Occupied);
  EXPECT_TRUE(wall_holes(test::measured(std::move(cells))).empty());
}

/// A short piece that many scans passed is a hole, a long one the floor of a slope.
TEST(WallHoles, ShowAsPiecesThatManyScansPassed) {
  for (const auto& [cells, holes] : {std::pair<int, std::size_t>{1, 1}, {3, 1}, {4, 1}, {5, 0}, {12, 0}}) {
    Traversable floor = test::measured(across(0.05));
    const Cell first = floor.cells.cell({1.225, 1.525});
    for (int i = 0; i < cells; ++i) floor.unsure[{first.x + i, first.y}] = 1;
    EXPECT_EQ(wall_holes(floor).size(), holes) << cells;
  }
}

TEST(WallHoles, MakeTheirBoardWorthALookAndNothingElse) {
  const auto holes = wall_holes(opened(1.4, 1.55));
  ASSERT_EQ(holes.size(), 1U);
  for (const double side : {-1.0, 1.0}) {
    EXPECT_TRUE(beside_hole(holes, {1.475 + side * 0.6, 1.525 + side * 0.05}, {1, 0})) << "the next hole of a board";
    EXPECT_FALSE(beside_hole(holes, {1.475 + side * 1.0, 1.525 + side * 0.05}, {1, 0})) << "the next board";
    EXPECT_FALSE(beside_hole(holes, {1.475, 1.525 + side * 0.3}, {1, 0})) << "another wall";
  }
  EXPECT_FALSE(beside_hole(holes, {1.475, 1.475}, {0, 1})) << "a wall across";
}

}  // namespace
}  // namespace rubble::explore
