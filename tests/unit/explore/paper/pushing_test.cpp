#include "explore/paper/pushing.h"

#include <gtest/gtest.h>

#include "explore/paper/known_ground.h"
#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

const TPose2D kRobot{2.0, 2.0, 0.0};
const TPoint2D kBallAt{2.6, 2.0};

/// A room of 4 x 4 m with a ball before the robot and a wall behind the ball.
Traversable floor_with_ball(const Pushing& pushing) {
  OccupancyGrid cells = test::room(4.0, 4.0);
  test::fill(cells, kBallAt.x - 0.1, kBallAt.y - 0.1, kBallAt.x + 0.1, kBallAt.y + 0.1, Occupancy::Occupied);
  test::fill(cells, 3.2, 0.0, 3.3, 4.0, Occupancy::Occupied);
  Traversable floor = traversable(std::move(cells));
  pushing.free_things(floor);
  measure_clearance(floor, 1.2);
  return floor;
}

TEST(Pushing, BeginsWithSmallThingsAndEndsWithAllThatIsOffTheGrid) {
  Pushing pushing;
  const Traversable floor = floor_with_ball(pushing);
  EXPECT_FALSE(pushing.on());
  for (const auto what : {Pushing::What::Single, Pushing::What::Heaps, Pushing::What::Strips, Pushing::What::OffGrid}) {
    EXPECT_TRUE(pushing.more());
    EXPECT_EQ(pushing.start(floor), what);
  }
  EXPECT_FALSE(pushing.more());
  pushing.end();
  EXPECT_FALSE(pushing.on());
  EXPECT_TRUE(pushing.more());
}

TEST(Pushing, IsWorthWhileOnceForEachPieceOfGroundGained) {
  Pushing pushing;
  const Traversable small = test::measured(test::room(4.0, 4.0)), same = test::measured(test::room(4.0, 4.1)),
                    large = test::measured(test::room(4.0, 5.0));
  EXPECT_TRUE(pushing.worth(small)) << "it was not tried yet";
  pushing.start(small);
  EXPECT_TRUE(pushing.worth(small)) << "it has begun";
  pushing.end();
  EXPECT_FALSE(pushing.worth(small));
  EXPECT_FALSE(pushing.worth(same));
  EXPECT_TRUE(pushing.worth(large));
  pushing.new_round();
  EXPECT_FALSE(pushing.on());
  EXPECT_TRUE(pushing.worth(small));
}

TEST(Pushing, WhatIsPushedIsNoNewObstacleAndAllElseIs) {
  Pushing pushing;
  const TPoint2D on_ball{2.5, 2.0}, on_wall{3.2, 2.0}, on_other{2.3, 2.8};
  const std::vector<TPoint2D> hits = {on_ball, on_wall, on_other};
  EXPECT_EQ(pushing.without_loose_things(hits, kRobot, floor_with_ball(Pushing())).size(), 3u) << "nothing is pushed";
  pushing.start(floor_with_ball(Pushing()));
  const Traversable floor = floor_with_ball(pushing);
  ASSERT_FALSE(floor.loose.empty());
  const std::vector<TPoint2D> rest = pushing.without_loose_things(hits, kRobot, floor);
  EXPECT_TRUE(pushing.near_loose_things());
  ASSERT_EQ(rest.size(), 2u);
  EXPECT_EQ(rest[0].x, on_wall.x);
  EXPECT_EQ(rest[1].x, on_other.x);
  pushing.without_loose_things({on_wall}, kRobot, floor);
  EXPECT_FALSE(pushing.near_loose_things());
  EXPECT_EQ(pushing.without_loose_things(hits, {0.5, 2.0, 0.0}, floor).size(), 3u) << "it is not near the robot yet";
}

/// The map shows the ball where it lay; the scans see it roll on.
TEST(Pushing, FollowsWhatRolls) {
  Pushing pushing;
  pushing.start(floor_with_ball(Pushing()));
  const Traversable floor = floor_with_ball(pushing);
  TPoint2D ball = kBallAt;
  for (; ball.y < 2.8; ball.y += 0.1)
    EXPECT_TRUE(pushing.without_loose_things({ball}, kRobot, floor).empty()) << ball.y;
  EXPECT_EQ(pushing.without_loose_things({{ball.x, ball.y - 0.4}}, kRobot, floor).size(), 1u)
      << "what is found elsewhere is another thing";
}

/// From its foot a slope shows as a wall; what is met from half a metre is none.
TEST(Pushing, WhatMayBeFloorIsNewWhereItIsMetFromNearOnly) {
  OccupancyGrid cells = test::corridor_of_pallets(5.6, test::kPallet, Occupancy::Unknown);
  Pushing pushing(test::kPallet);
  Traversable floor = test::measured(cells);
  while (pushing.more()) pushing.start(floor);
  pushing.free_things(floor);
  ASSERT_FALSE(floor.doubtful.empty());
  measure_clearance(floor, 1.2);
  std::vector<TPoint2D> hits;
  for (double y = 0.5; y < 0.7; y += 0.02) hits.emplace_back(5.6, y);
  for (const double away : {1.8, 1.1, 0.8}) {
    EXPECT_TRUE(pushing.without_loose_things(hits, {5.6 - away, 0.6, 0.0}, floor).empty()) << away;
    EXPECT_TRUE(pushing.solid().empty()) << away;
    EXPECT_EQ(pushing.near_loose_things(), away < 1.0) << "it slows down: it may have to stop";
  }
  EXPECT_EQ(pushing.without_loose_things(hits, {5.1, 0.6, 0.0}, floor).size(), hits.size());
  ASSERT_FALSE(pushing.solid().empty());
  for (const TPoint2D& p : pushing.solid()) EXPECT_EQ(floor.cells[floor.cells.cell(p)], Occupancy::Free) << p;
  EXPECT_EQ(pushing.without_loose_things({hits[0], hits[1]}, {5.1, 0.6, 0.0}, floor).size(), 2u);
  EXPECT_TRUE(pushing.solid().empty()) << "two may be noise";
}

/// What was looked over from near is free whatever is pushed: from farther off scans meet it still.
TEST(Pushing, WhatWasFoundToBeFloorIsNoNewObstacleWhileNothingIsPushed) {
  Traversable floor = test::measured(test::corridor_of_pallets(5.6, 0.0, Occupancy::Free));
  for (double y = 0.1; y < 1.1; y += 0.05) floor.doubtful.push_back(floor.cells.cell({5.6, y}));
  Pushing pushing(test::kPallet);
  std::vector<TPoint2D> hits;
  for (double y = 0.5; y < 0.7; y += 0.02) hits.emplace_back(5.6, y);
  EXPECT_TRUE(pushing.without_loose_things(hits, {4.2, 0.6, 0.0}, floor).empty());
  EXPECT_EQ(pushing.without_loose_things(hits, {5.1, 0.6, 0.0}, floor).size(), hits.size()) << "met from near";
  EXPECT_FALSE(pushing.solid().empty());
}

TEST(KnownGround, HasGrownByASquareMetre) {
  KnownGround ground;
  EXPECT_FALSE(ground.marked());
  const Traversable small = test::measured(test::room(4.0, 4.0));
  EXPECT_TRUE(ground.grown(small)) << "from nothing";
  ground.mark(small);
  EXPECT_TRUE(ground.marked());
  EXPECT_FALSE(ground.grown(small));
  EXPECT_FALSE(ground.grown(test::measured(test::room(4.0, 4.2))));
  EXPECT_TRUE(ground.grown(test::measured(test::room(4.0, 4.3))));
  EXPECT_FALSE(ground.grown(test::measured(test::room(3.0, 3.0)))) << "it has shrunk";
  ground.forget();
  EXPECT_FALSE(ground.marked());
}

}  // namespace
}  // namespace rubble::explore
