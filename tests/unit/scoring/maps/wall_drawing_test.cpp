#include "scoring/maps/wall_drawing.h"

#include <gtest/gtest.h>

#include "scoring/scorecard.h"
#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;

/// All cells but the walls become `ground`.
OccupancyGrid drawn(const OccupancyGrid& map, Occupancy ground) {
  OccupancyGrid out = map;
  for (Occupancy& cell : out.cells())
    if (cell != Occupancy::Occupied) cell = ground;
  return out;
}

double equal_cells(const OccupancyGrid& a, const OccupancyGrid& b) {
  double same = 0.0;
  for (std::size_t i = 0; i < a.cells().size(); ++i) same += a.cells()[i] == b.cells()[i] ? 1.0 : 0.0;
  return same / static_cast<double>(a.cells().size());
}

TEST(WallDrawing, WhatWallsEncloseIsFreeAndWhatLiesOutsideUnknown) {
  const OccupancyGrid truth = maze({});
  for (const Occupancy ground : {Occupancy::Free, Occupancy::Unknown}) {
    const FloodedDrawing found = flood_drawing(drawn(truth, ground));
    EXPECT_FALSE(found.note.empty());
    EXPECT_EQ(equal_cells(found.grid, truth), 1.0);
    EXPECT_NEAR(score_map(found.grid, truth).score, 1.0, 1e-9);
    EXPECT_NEAR(score_map(truth, found.grid).score, 1.0, 1e-9);
  }
}

TEST(WallDrawing, ASlitInTheOuterWallHoldsTheFlood) {
  OccupancyGrid truth = maze({});
  for (int y = 0; y < truth.height(); ++y)
    for (int x = 0; x < truth.width(); ++x)
      if (truth.centre({x, y}).x < 0.2 && std::abs(truth.centre({x, y}).y - 3.0) < 0.09 &&
          truth[{x, y}] == Occupancy::Occupied)
        truth[{x, y}] = Occupancy::Free;
  EXPECT_GT(equal_cells(flood_drawing(drawn(truth, Occupancy::Unknown)).grid, truth), 0.99);
}

TEST(WallDrawing, MapsThatKnowBothAreLeftAlone) {
  const OccupancyGrid truth = maze({});
  EXPECT_EQ(flood_drawing(truth).grid.cells(), truth.cells());
  EXPECT_TRUE(flood_drawing(truth).note.empty());
  for (const Occupancy all : {Occupancy::Free, Occupancy::Unknown, Occupancy::Occupied}) {
    const OccupancyGrid plain(truth.frame(), all);
    EXPECT_EQ(flood_drawing(plain).grid.cells(), plain.cells());
  }
}

TEST(WallDrawing, WallsThatEncloseNothingSayThatFreeSpaceIsNotKnown) {
  OccupancyGrid map(GridFrame{100, 60, 0.05, 0.0, 0.0});
  draw_wall(map, {1.0, 1.0}, {4.0, 1.0}, 2);
  draw_wall(map, {1.0, 1.0}, {1.0, 2.0}, 2);
  const FloodedDrawing found = flood_drawing(map);
  EXPECT_EQ(found.grid.cells(), map.cells());
  EXPECT_NE(found.note.find("enclose nothing"), std::string::npos) << found.note;
}

/// A part cut out of a building: its walls run into the rim.
TEST(WallDrawing, APieceCutOutOfAMapIsNoDrawing) {
  OccupancyGrid map(GridFrame{100, 60, 0.05, 0.0, 0.0}, Occupancy::Free);
  draw_wall(map, {2.5, 0.0}, {2.5, 3.0}, 2);
  EXPECT_EQ(flood_drawing(map).grid.cells(), map.cells());
}

}  // namespace
}  // namespace rubble::scoring
