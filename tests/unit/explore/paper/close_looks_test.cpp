#include "explore/paper/close_looks.h"

#include <gtest/gtest.h>

#include "explore/paper/doubtful_walls.h"
#include "explore/paper/off_grid.h"
#include "tests/support/explore_grids.h"
#include "tests/support/planted_mapper.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using test::corridor_of_pallets;

constexpr double kWallAt = 5.6;  ///< well inside a pallet [m]
const Anchor kBefore{Stamp::from_seconds(1.0), {kWallAt - 0.7, 0.6, 0.0}};
const TPoint2D kLaser{0.145, 0.0};

/// What a scan of the corridor sees from the robot: the wall, or what is `beyond` it [m].
std::vector<TPoint2D> scan(double beyond) {
  std::vector<TPoint2D> hits;
  const TPoint2D origin = kBefore.T_map_base.composePoint(kLaser);
  const double range = kWallAt - origin.x;
  for (double y = -0.45; y <= 0.45; y += 0.004)
    hits.emplace_back(kWallAt + beyond, origin.y + y * (range + beyond) / range);
  return hits;
}

int walls_left(const Traversable& floor) {
  int cells = 0;
  for (double y = 0.3; y < 0.9; y += 0.05)
    cells += floor.cells[floor.cells.cell({kWallAt + 0.02, y})] == Occupancy::Occupied ? 1 : 0;
  return cells;
}

struct Looker {
  Traversable floor() const {
    Traversable floor = test::measured(corridor_of_pallets(at, test::kPallet, Occupancy::Unknown));
    looks.apply(floor);
    return floor;
  }
  void look(int times, double beyond) {
    for (int i = 0; i < times; ++i) looks.look(scan(beyond), kBefore.T_map_base);
  }

  double at = kWallAt;
  CloseLooks looks{test::kPallet, kLaser};
};

TEST(CloseLooks, WhatTheyPassOverIsFloorForGood) {
  Looker robot;
  const int before = walls_left(robot.floor());
  ASSERT_GT(before, 5);
  robot.look(4, 1.5);
  EXPECT_EQ(robot.looks.judge(robot.floor(), kBefore), CloseLooks::Verdict::Open) << "too few";
  robot.look(1, 1.5);
  EXPECT_EQ(robot.looks.judge(robot.floor(), kBefore), CloseLooks::Verdict::Floor);
  EXPECT_EQ(walls_left(robot.floor()), 0);
  robot.looks.look_away();
  EXPECT_EQ(walls_left(robot.floor()), 0) << "from elsewhere too";
  EXPECT_EQ(robot.looks.judge(robot.floor(), kBefore), CloseLooks::Verdict::Open) << "it was not looked at again";
}

TEST(CloseLooks, WhatTheyMeetIsSolidAndNeitherLookedAtNorDrivenAtAgain) {
  Looker robot;
  ASSERT_FALSE(doubtful_walls(robot.floor(), test::kPallet).empty());
  robot.look(6, 0.0);
  EXPECT_EQ(robot.looks.judge(robot.floor(), kBefore), CloseLooks::Verdict::Solid);
  const Traversable floor = robot.floor();
  EXPECT_EQ(walls_left(floor), walls_left(Looker().floor()));
  EXPECT_TRUE(doubtful_walls(floor, test::kPallet).empty());
  Traversable freed = floor;
  free_off_grid(freed, test::kPallet);
  EXPECT_EQ(walls_left(freed), walls_left(floor));
  Traversable untried = Looker().floor();
  free_off_grid(untried, test::kPallet);
  EXPECT_LT(walls_left(untried), walls_left(floor)) << "before it was looked at it was driven at";
}

/// A wall that is floor for a part and solid beside it: who stands there is not told the same for ever.
TEST(CloseLooks, EachPieceOfFloorIsNewsOnce) {
  Looker robot;
  std::vector<TPoint2D> half;
  for (const TPoint2D& hit : scan(1.5))
    if (hit.y > kBefore.T_map_base.y) half.push_back(hit);
  for (const TPoint2D& hit : scan(0.0))
    if (hit.y <= kBefore.T_map_base.y) half.push_back(hit);
  for (int i = 0; i < 9; ++i) robot.looks.look(half, kBefore.T_map_base);
  EXPECT_EQ(robot.looks.judge(robot.floor(), kBefore), CloseLooks::Verdict::Floor);
  ASSERT_GT(walls_left(robot.floor()), 0);
  ASSERT_LT(walls_left(robot.floor()), walls_left(Looker().floor()));
  EXPECT_NE(robot.looks.judge(robot.floor(), kBefore), CloseLooks::Verdict::Floor);
}

TEST(CloseLooks, TellNothingWhereTheyDisagreeOrSomethingStandsBefore) {
  Looker torn;
  torn.look(6, 0.0);
  torn.look(6, 1.5);
  EXPECT_EQ(torn.looks.judge(torn.floor(), kBefore), CloseLooks::Verdict::Open);
  Looker hidden;
  hidden.look(9, -0.3);
  EXPECT_EQ(hidden.looks.judge(hidden.floor(), kBefore), CloseLooks::Verdict::Open);
  Looker blind;
  for (int i = 0; i < 9; ++i) blind.looks.look({}, kBefore.T_map_base);
  EXPECT_EQ(blind.looks.judge(blind.floor(), kBefore), CloseLooks::Verdict::Open);
}

TEST(CloseLooks, WallsOnTheEdgesOfPalletsAndInArenasWithoutAreBelieved) {
  Looker edge;
  edge.at = 4 * test::kPallet + 0.02;  // the scans pass over it, as from the top of a ramp over a low wall
  for (int i = 0; i < 9; ++i) {
    const TPose2D before{edge.at - 0.7, 0.6, 0.0};
    std::vector<TPoint2D> hits;
    for (double y = -2.0; y < 2.0; y += 0.01) hits.emplace_back(edge.at + 1.5, 0.6 + y);
    edge.looks.look(hits, before);
    const Anchor robot{kBefore.stamp, before};
    EXPECT_EQ(edge.looks.judge(edge.floor(), robot), CloseLooks::Verdict::Open);
  }
  Looker elsewhere;
  elsewhere.looks = CloseLooks(0.0, kLaser);
  elsewhere.look(9, 1.5);
  EXPECT_EQ(elsewhere.looks.judge(elsewhere.floor(), kBefore), CloseLooks::Verdict::Open);
}

TEST(CloseLooks, MoveWithThePosesThatTheyWereMadeFrom) {
  test::PlantedMapper mapper;
  mapper.plant(kBefore.stamp, kBefore.T_map_base);
  const TPose2D shift{0.0, 2.0 * test::kPallet, 0.0};
  Looker over, met;
  over.look(9, 1.5);
  ASSERT_EQ(over.looks.judge(over.floor(), kBefore), CloseLooks::Verdict::Floor);
  met.looks.met(scan(0.0), kBefore);
  over.look(9, 1.5);
  mapper.correct(Stamp::from_seconds(5.0), shift);
  for (Looker* robot : {&over, &met}) robot->looks.follow(mapper);
  EXPECT_GT(walls_left(over.floor()), 0) << "the floor that was found lies elsewhere now";
  EXPECT_EQ(over.looks.judge(over.floor(), kBefore), CloseLooks::Verdict::Open) << "looks of the old map count no more";
  EXPECT_FALSE(doubtful_walls(met.floor(), test::kPallet).empty()) << "and so does what is solid";
}

/// One cell of it that scans passed over makes no wall the floor of a slope.
TEST(CloseLooks, TakesALittleForNoFloor) {
  Looker robot;
  std::vector<TPoint2D> hits;
  for (const TPoint2D& hit : scan(1.5))
    if (std::abs(hit.y - kBefore.T_map_base.y) < 0.2) hits.push_back(hit);
  for (int i = 0; i < 9; ++i) robot.looks.look(hits, kBefore.T_map_base);
  EXPECT_EQ(robot.looks.judge(robot.floor(), kBefore), CloseLooks::Verdict::Open);
  EXPECT_EQ(walls_left(robot.floor()), walls_left(Looker().floor()));
}

/// Met on the way by a single scan, e.g. while it is driven at in the hope that it is none.
TEST(CloseLooks, WhatIsMetOnTheWayIsSolidEvenIfItPassedForFloor) {
  Looker robot;
  robot.look(9, 1.5);
  ASSERT_EQ(robot.looks.judge(robot.floor(), kBefore), CloseLooks::Verdict::Floor);
  ASSERT_EQ(walls_left(robot.floor()), 0);
  robot.looks.met(scan(0.0), kBefore);
  EXPECT_EQ(walls_left(robot.floor()), walls_left(Looker().floor()));
}

}  // namespace
}  // namespace rubble::explore
