#include "scoring/measures/wall_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <random>
#include <vector>

#include "base/angle.h"
#include "scoring/measures/dashes.h"

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

/// A map of 8 x 8 m, unknown, but for a wall of 6 m through its middle: dashes and gaps along it, and the cells of what
/// is drawn.
struct Dashed {
  Dashed(double heading, double dash, double gap) : grid(GridFrame{160, 160, 0.05, 0.0, 0.0}, Occupancy::Unknown) {
    const double begin = -3.0, step = 0.005;
    for (double along = begin; along < 3.0; along += step)
      if (std::fmod(along - begin, dash + gap) < dash) {
        const Cell c = grid.cell({4.0 + along * std::cos(heading), 4.0 + along * std::sin(heading)});
        if (grid[c] != Occupancy::Occupied) cells.push_back(c);
        grid[c] = Occupancy::Occupied;
      }
  }
  /// Mean strength of what is drawn.
  double strength() const {
    const WallPieces pieces = wall_pieces(grid);
    double sum = 0.0;
    for (const Cell& c : cells) sum += static_cast<double>(pieces.strength[c]);
    return sum / static_cast<double>(cells.size());
  }
  OccupancyGrid grid;
  std::vector<Cell> cells;
};

/// What a robot draws of a wall askew to the raster.
TEST(WallPieces, DashesEndToEndAreOneWallWhicheverWayItRuns) {
  for (int degrees = 0; degrees < 180; degrees += 7) {
    const double heading = degrees * kPi / 180.0;
    EXPECT_GT(Dashed(heading, 0.14, 0.06).strength(), 0.95) << degrees;
    EXPECT_GT(Dashed(heading, 0.10, 0.08).strength(), 0.90) << degrees;
  }
}

TEST(WallPieces, DashesFarApartStayPieces) {
  for (int degrees = 0; degrees < 180; degrees += 7)
    EXPECT_LT(Dashed(degrees * kPi / 180.0, 0.10, 0.26).strength(), 0.60) << degrees;
}

TEST(WallPieces, WhatStandsBesideDashesLeavesThemPieces) {
  for (int degrees = 0; degrees < 180; degrees += 7) {
    const double heading = degrees * kPi / 180.0;
    Dashed walls(heading, 0.10, 0.10);
    const double alone = walls.strength();
    const OccupancyGrid before = walls.grid;
    // A row beside it on each side, between the gaps: 0.15 m away it touches nothing.
    std::mt19937 random(static_cast<unsigned>(degrees));
    std::uniform_real_distribution<double> place(-3.0, 3.0);
    for (int i = 0; i < 60; ++i) {
      const double along = place(random), across = i % 2 == 0 ? 0.14 : -0.14;
      walls.grid[walls.grid.cell({4.0 + along * std::cos(heading) - across * std::sin(heading),
                                  4.0 + along * std::sin(heading) + across * std::cos(heading)})] = Occupancy::Occupied;
    }
    EXPECT_LT(walls.strength(), alone + 0.05) << degrees;
  }
}

/// Specks thrown anywhere are as much wall as before they could be dashes: a map with salt is not full of walls.
TEST(WallPieces, SaltIsNoDash) {
  for (const double share : {0.01, 0.05, 0.10}) {
    std::mt19937 random(7);
    OccupancyGrid grid(GridFrame{400, 400, 0.05, 0.0, 0.0}, Occupancy::Free);
    for (Occupancy& cell : grid.cells())
      if (std::bernoulli_distribution(share)(random)) cell = Occupancy::Occupied;
    const auto salt = static_cast<double>(std::count(grid.cells().begin(), grid.cells().end(), Occupancy::Occupied));
    EXPECT_LT(static_cast<double>(dashes_in_line(grid).size()), 0.01 * salt) << share;
  }
}

double seconds_for_pieces(const OccupancyGrid& grid) {
  const std::clock_t start = std::clock();
  EXPECT_EQ(wall_pieces(grid).strength.frame(), grid.frame());
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

// A picture of millimetres: within the longest gap of each speck lie a hundred others, thousands of cells away.
TEST(WallPieces, SaltOfAFineMapIsNotWorkedOnSpeckBySpeck) {
  std::mt19937 random(3);
  OccupancyGrid salt(GridFrame{400, 400, 0.002, 0.0, 0.0}, Occupancy::Free);
  for (Occupancy& cell : salt.cells())
    if (random() % 100 == 0) cell = Occupancy::Occupied;
  EXPECT_LT(seconds_for_pieces(salt), 2.0);
}

TEST(WallPieces, WhatWouldTakeTooLongFindsNoDashes) {
  const Dashed wall(0.6, 0.10, 0.08);
  EXPECT_FALSE(dashes_in_line(wall.grid, 1e6).empty());
  EXPECT_TRUE(dashes_in_line(wall.grid, 1e3).empty());
}

}  // namespace
}  // namespace rubble::scoring
