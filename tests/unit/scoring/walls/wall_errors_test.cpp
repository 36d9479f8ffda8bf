#include "scoring/walls/wall_errors.h"

#include <gtest/gtest.h>

#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;

OccupancyGrid room() {
  OccupancyGrid grid(GridFrame{220, 220, 0.05, -0.5, -0.5}, Occupancy::Free);
  for (const auto& [a, b] : {std::pair{TPoint2D(0, 0), TPoint2D(10, 0)},
                             {TPoint2D(10, 0), TPoint2D(10, 10)},
                             {TPoint2D(10, 10), TPoint2D(0, 10)},
                             {TPoint2D(0, 10), TPoint2D(0, 0)}})
    draw_wall(grid, a, b, 2);
  return grid;
}

TEST(WallErrors, AreNoneForThePerfectMap) {
  const OccupancyGrid truth = room();
  const WallErrors errors = wall_errors(WallOverlap(truth, truth, 0.5), PlanarTransform(), 10);
  EXPECT_EQ(errors.phantom_m, 0.0);
  EXPECT_EQ(errors.missing_m, 0.0);
  EXPECT_TRUE(errors.worst.empty());
}

TEST(WallErrors, MeasureAPhantomAndAMissingWallAndSayWhere) {
  const OccupancyGrid truth = room();
  OccupancyGrid with_wall = truth;
  draw_wall(with_wall, {3.0, 4.4}, {5.0, 4.4}, 2);
  const WallErrors phantom = wall_errors(WallOverlap(with_wall, truth, 0.5), PlanarTransform(), 10);
  EXPECT_NEAR(phantom.phantom_m, 2.0, 0.3);
  EXPECT_EQ(phantom.missing_m, 0.0);
  ASSERT_FALSE(phantom.worst.empty());
  EXPECT_NEAR(phantom.worst.front().p_truth.x, 4.2, 0.9);
  EXPECT_NEAR(phantom.worst.front().p_truth.y, 4.4, 0.1);

  const WallErrors missing = wall_errors(WallOverlap(truth, with_wall, 0.5), PlanarTransform(), 10);
  EXPECT_NEAR(missing.missing_m, 2.0, 0.3);
  EXPECT_EQ(missing.phantom_m, 0.0);
  double listed = 0.0;
  for (const WrongPlace& place : missing.worst) listed += place.missing_m;
  EXPECT_NEAR(listed, missing.missing_m, 0.11);
}

TEST(WallErrors, WallsWhereTheTruthIsUnknownAreIgnoredAndSaySo) {
  OccupancyGrid truth = room();
  for (int y = 0; y < 220; ++y)
    for (int x = 110; x < 220; ++x) truth[{x, y}] = Occupancy::Unknown;  // the half beyond x = 5
  OccupancyGrid map = room();
  draw_wall(map, {7.0, 4.0}, {9.0, 4.0}, 2);
  const WallOverlap walls(map, truth, 0.5);
  const WallErrors errors = wall_errors(walls, PlanarTransform(), 10);
  // Three sides of the room and the wall in it, but for the mean k over tau where two of the sides go on from what is
  // known; lengths are known to 5 %, as thickness is.
  EXPECT_NEAR(errors.ignored_m, 5.0 + 10.0 + 5.0 + 2.0 - 2.0 * 0.25, 1.5);
  EXPECT_NEAR(errors.phantom_m, 0.0, 0.05);
  EXPECT_NEAR(errors.missing_m, 0.0, 0.05);
  EXPECT_NEAR(walls.at(PlanarTransform()).score, 1.0, 0.001);
  EXPECT_EQ(wall_errors(WallOverlap(truth, map, 0.5), PlanarTransform(), 10).ignored_m, 0.0);
}

/// The room with nothing known beyond its walls, as a truth drawn from what can be seen.
OccupancyGrid seen_room() {
  OccupancyGrid grid = room();
  for (int y = 0; y < 220; ++y)
    for (int x = 0; x < 220; ++x)
      if (grid[{x, y}] == Occupancy::Free && (x < 10 || y < 10 || x > 209 || y > 209))
        grid[{x, y}] = Occupancy::Unknown;
  return grid;
}

TEST(WallErrors, ThickerWallsOfTheSameMapAreNotIgnored) {
  const OccupancyGrid truth = seen_room();
  OccupancyGrid thicker = truth;
  for (int y = 1; y < 219; ++y)
    for (int x = 1; x < 219; ++x)
      for (const Cell next : {Cell{x - 1, y}, Cell{x + 1, y}, Cell{x, y - 1}, Cell{x, y + 1}})
        if (truth[next] == Occupancy::Occupied) thicker[{x, y}] = Occupancy::Occupied;
  EXPECT_EQ(wall_errors(WallOverlap(truth, truth, 0.5), PlanarTransform(), 10).ignored_m, 0.0);
  EXPECT_LT(wall_errors(WallOverlap(thicker, truth, 0.5), PlanarTransform(), 10).ignored_m, 0.3);
}

TEST(WallErrors, AWallInTheUnknownIsIgnoredAtItsLength) {
  OccupancyGrid truth = room();
  for (int y = 60; y < 160; ++y)
    for (int x = 60; x < 160; ++x) truth[{x, y}] = Occupancy::Unknown;
  OccupancyGrid map = room();
  draw_wall(map, {3.5, 5.0}, {6.5, 5.0}, 2);
  EXPECT_NEAR(wall_errors(WallOverlap(map, truth, 0.5), PlanarTransform(), 10).ignored_m, 3.0, 0.3);
}

/// However many places are listed, and whatever else is wrong there.
TEST(WallErrors, TheLengthOfGapsIsThatOfAllWindows) {
  const OccupancyGrid truth = room();
  OccupancyGrid map = truth;
  for (int y = 0; y < 220; ++y)
    for (int x = 0; x < 220; ++x)
      if (map.centre({x, y}).x > 9.8) map[{x, y}] = Occupancy::Free;  // one side of 10 m
  for (const OccupancyGrid& with : {map, with_phantoms(map, 40, 3)}) {
    const WallOverlap walls(with, truth, 0.5);
    const WallErrors all = wall_errors(walls, PlanarTransform(), 1000);
    double gaps = 0.0;
    for (const WrongPlace& place : all.worst) gaps += place.missing_m >= 0.4 ? place.missing_m : 0.0;
    EXPECT_NEAR(all.gaps_m, gaps, 1e-9);
    EXPECT_GT(all.gaps_m, 8.0);
    EXPECT_LE(all.gaps_m, all.missing_m);
    for (const std::size_t places : {0U, 1U, 3U})
      EXPECT_EQ(wall_errors(walls, PlanarTransform(), places).gaps_m, all.gaps_m) << places;
  }
}

TEST(WallErrors, WhatOnlyWaversHasNoGaps) {
  const OccupancyGrid truth = room();
  OccupancyGrid map(truth.frame(), Occupancy::Free);
  for (int y = 0; y < 219; ++y)
    for (int x = 0; x < 219; ++x) map[{x, y}] = truth[{x + 1, y + 1}];
  const WallErrors errors = wall_errors(WallOverlap(map, truth, 0.5), PlanarTransform(), 10);
  EXPECT_GT(errors.missing_m, 0.0);
  EXPECT_EQ(errors.gaps_m, 0.0);
}

TEST(WallErrors, ListTheWorstFirstAndNoMoreThanAsked) {
  const OccupancyGrid truth = room();
  const OccupancyGrid map = with_phantoms(truth, 40, 3);
  const WallErrors errors = wall_errors(WallOverlap(map, truth, 0.5), PlanarTransform(), 10);
  ASSERT_EQ(errors.worst.size(), 10U);
  for (std::size_t i = 1; i < errors.worst.size(); ++i)
    EXPECT_GE(errors.worst[i - 1].wrong_m(), errors.worst[i].wrong_m());
}

}  // namespace
}  // namespace rubble::scoring
