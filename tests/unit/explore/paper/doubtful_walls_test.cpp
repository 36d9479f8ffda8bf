#include "explore/paper/doubtful_walls.h"

#include <gtest/gtest.h>

#include "explore/paper/target_choice.h"
#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

using test::corridor_of_pallets;
using test::kPallet;

std::vector<Source> found(double x, double width, Occupancy behind, double pallet = kPallet) {
  return doubtful_walls(test::measured(corridor_of_pallets(x, width, behind)), pallet);
}

TEST(DoubtfulWalls, AWallOffTheEdgesOfThePalletsThatHidesGroundMayBeARamp) {
  const OccupancyGrid cells = corridor_of_pallets(5.6, kPallet, Occupancy::Unknown);
  const std::vector<Source> places = found(5.6, kPallet, Occupancy::Unknown);
  ASSERT_FALSE(places.empty());
  for (const Source& place : places) {
    const auto p = cells.centre(place.cell);
    EXPECT_GT(p.x, 5.6 - 0.7);
    EXPECT_LT(p.x, 5.6 - 0.4);
    EXPECT_LT(p.y, kPallet);
  }
}

TEST(DoubtfulWalls, OtherWallsAreWhatTheySeem) {
  EXPECT_TRUE(found(5.6, kPallet, Occupancy::Free).empty()) << "seen from both sides";
  EXPECT_TRUE(found(4 * kPallet, kPallet, Occupancy::Unknown).empty()) << "on an edge";
  EXPECT_TRUE(found(4 * kPallet + 0.15, kPallet, Occupancy::Unknown).empty()) << "and a little off it";
  EXPECT_TRUE(found(5.6, 0.42, Occupancy::Unknown).empty()) << "the side of a box";
  EXPECT_TRUE(found(5.6, kPallet, Occupancy::Unknown, 0.0).empty()) << "an arena without pallets";
}

/// Floor on both sides of a wall: the ways to them meet, or it was seen from upon a slope, and the scans from its foot
/// shut it off.
TEST(DoubtfulWalls, FloorBehindThatIsReachedAnotherWayIsNoReasonAndFloorShutOffIs) {
  OccupancyGrid cells = corridor_of_pallets(5.6, kPallet, Occupancy::Free);
  EXPECT_TRUE(doubtful_walls(test::measured(cells), kPallet).empty()) << "all of it known";
  test::fill(cells, 9.0, 0.06, 8 * kPallet - 0.06, kPallet - 0.06, Occupancy::Unknown);
  EXPECT_FALSE(doubtful_walls(test::measured(cells), kPallet).empty()) << "shut off, and it goes on";
  OccupancyGrid small = cells;
  test::fill(small, 6.1, 0.06, 8 * kPallet - 0.06, kPallet - 0.06, Occupancy::Occupied);
  EXPECT_TRUE(doubtful_walls(test::measured(small), kPallet).empty()) << "half a square metre";
  test::fill(cells, 4.8, kPallet - 0.04, 5.4, kPallet + 0.04, Occupancy::Free);
  test::fill(cells, 5.8, kPallet - 0.04, 6.0, kPallet + 0.04, Occupancy::Free);
  test::fill(cells, 4.8, kPallet + 0.04, 6.4, 2 * kPallet - 0.1, Occupancy::Free);
  EXPECT_FALSE(doubtful_walls(test::measured(cells), kPallet).empty()) << "round about, for a cat";
  test::fill(cells, 5.8, kPallet - 0.04, 6.4, kPallet + 0.04, Occupancy::Free);
  EXPECT_TRUE(doubtful_walls(test::measured(cells), kPallet).empty()) << "round about";
}

/// Over the first of it the laser sees a strip of the slope, which is no ground that it got to.
TEST(DoubtfulWalls, FloorThatShowsAsAThickWallOrAsTwoIsOneToo) {
  OccupancyGrid cells = corridor_of_pallets(5.3, kPallet, Occupancy::Unknown);
  test::fill(cells, 5.3, 0.05, 5.5, kPallet - 0.05, Occupancy::Occupied);
  EXPECT_FALSE(doubtful_walls(test::measured(cells), kPallet).empty()) << "thick";
  test::fill(cells, 5.5, 0.05, 5.65, kPallet - 0.05, Occupancy::Free);
  test::fill(cells, 5.65, 0.05, 5.7, kPallet - 0.05, Occupancy::Occupied);
  EXPECT_FALSE(doubtful_walls(test::measured(cells), kPallet).empty()) << "two";
  test::fill(cells, 5.65, 0.05, 5.95, kPallet - 0.05, Occupancy::Free);
  test::fill(cells, 5.95, 0.05, 6.0, kPallet - 0.05, Occupancy::Occupied);
  EXPECT_TRUE(doubtful_walls(test::measured(cells), kPallet).empty()) << "the second is a wall, on an edge";
}

/// As floor of a slope that the laser's plane meets here and there: drawn where an edge is, or its upper end on one.
TEST(DoubtfulWalls, OnAnEdgeAWallIsOneThatNearlyAllScansHit) {
  const auto unsure_within = [](const OccupancyGrid& cells, double x0, double x1) {
    Traversable floor = test::measured(cells);
    for (int y = 0; y < cells.height(); ++y)
      for (int x = 0; x < cells.width(); ++x) {
        const auto p = cells.centre({x, y});
        const bool within = p.x > x0 && p.x < x1 && p.y > 0.06 && p.y < kPallet - 0.06;
        if (within && cells[{x, y}] == Occupancy::Occupied) floor.unsure[{x, y}] = 1;
      }
    return doubtful_walls(floor, kPallet);
  };
  const double edge = 4 * kPallet;
  for (const double off : {0.0, 0.15, -0.15}) {
    OccupancyGrid cells = corridor_of_pallets(edge + off, kPallet, Occupancy::Unknown);
    EXPECT_FALSE(unsure_within(cells, edge - 0.3, edge + 0.3).empty()) << off;
    EXPECT_TRUE(unsure_within(cells, 0.0, edge - 0.3).empty()) << off << ": sure";
    // A wall is drawn thick where poses err: what stands before it is passed, and it is not.
    test::fill(cells, edge + off + 0.03, 0.06, edge + off + 0.08, kPallet - 0.06, Occupancy::Occupied);
    EXPECT_TRUE(unsure_within(cells, edge - 0.3, edge + off + 0.03).empty()) << off << ": a sure wall behind";
  }
  OccupancyGrid cells = corridor_of_pallets(5.6, kPallet, Occupancy::Unknown);
  test::fill(cells, 5.63, 0.06, 5.95, kPallet - 0.06, Occupancy::Free);
  test::fill(cells, 5.95, 0.06, 6.0, kPallet - 0.06, Occupancy::Occupied);
  EXPECT_TRUE(doubtful_walls(test::measured(cells), kPallet).empty()) << "a wall on the edge behind it";
  EXPECT_FALSE(unsure_within(cells, 5.5, 6.05).empty()) << "the upper end of the slope";
}

/// It is looked at when no frontier is left, once, and left alone when it stays.
TEST(DoubtfulWalls, AreLookedAtWhenNoFrontierIsInReach) {
  OccupancyGrid cells = corridor_of_pallets(5.6, kPallet, Occupancy::Unknown);
  LeftAlone left_alone{FeltConfig{}, PlannerConfig{}.same_target};
  SearchConfig config;
  config.on = false;
  FloorSearch search(config, 0.46, 0.4);
  TargetChoice choice(PlannerConfig{}, true, kPallet);
  const mrpt::math::TPose2D pose{2.0, 0.6, 0.0};
  const Stamp now = Stamp::from_seconds(1.0);
  const auto chosen = [&] {
    const Traversable floor = test::measured(cells);
    return choice.choose({floor, pose, now, left_alone}, search).plan;
  };
  const Plan look = chosen();
  ASSERT_TRUE(look.found);
  EXPECT_TRUE(look.doubtful);
  EXPECT_NEAR(look.target.x, 5.05, 0.1);
  // From nearer only a part of it is left, which is looked at all the same.
  choice.take(look);
  const OccupancyGrid before = cells;
  test::fill(cells, 5.55, 0.4, 5.65, 0.8, Occupancy::Free);
  test::fill(cells, 5.65, 0.4, 5.7, 0.8, Occupancy::Occupied);
  test::fill(cells, 5.4, 0.05, 5.45, 0.4, Occupancy::Occupied);
  test::fill(cells, 5.4, 0.8, 5.45, kPallet, Occupancy::Occupied);
  EXPECT_TRUE(chosen().doubtful);
  cells = before;
  left_alone.bar_for_good(look.target, {now, pose});
  EXPECT_FALSE(chosen().found);
  left_alone.pardon_all(now);
  test::fill(cells, 0.06, 0.3, 0.4, 0.9, Occupancy::Unknown);
  const Plan frontier = chosen();
  ASSERT_TRUE(frontier.found);
  EXPECT_FALSE(frontier.doubtful);
  EXPECT_LT(frontier.target.x, 1.0);
}

}  // namespace
}  // namespace rubble::explore
