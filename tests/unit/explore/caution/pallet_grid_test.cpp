#include "explore/caution/pallet_grid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angle.h"
#include "base/planar.h"
#include "base/rng.h"
#include "explore/caution/felt_obstacles.h"
#include "explore/caution/local_grids.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kPallet = 1.2;  // [m]
const robot::RobotModel kRobot;

Stamp after(double seconds) { return Stamp::from_seconds(seconds); }

/// A map of 8 x 8 m; walls stand on about half of the edges of a grid that lies at T_map_grid.
OccupancyGrid map_of_walls(const TPose2D& T_map_grid, Rng& rng) {
  GridFrame frame;
  frame.resolution = 0.05;
  frame.width = frame.height = 160;
  OccupancyGrid cells(frame, Occupancy::Free);
  const auto draw = [&](const TPoint2D& from, const TPoint2D& to) {
    for (double t = 0.0; t <= 1.0; t += 0.01) {
      const Cell c = frame.cell(T_map_grid.composePoint(from + (to - from) * t));
      if (frame.inside(c)) cells[c] = Occupancy::Occupied;
    }
  };
  for (int i = -10; i <= 10; ++i)
    for (int k = -10; k <= 10; ++k) {
      const TPoint2D corner{i * kPallet, k * kPallet};
      const double east = rng.uniform(), north = rng.uniform();
      if (east < 0.5) draw(corner, corner + TPoint2D{kPallet, 0.0});
      if (north < 0.5) draw(corner, corner + TPoint2D{0.0, kPallet});
    }
  return cells;
}

/// How far a place is from the nearest edge of a grid, along either axis [m].
double off_edges(const PalletGrid& grid, const TPoint2D& p_map) {
  const TPoint2D p = grid.to_grid(p_map);
  return kPallet * std::max(std::abs(p.x - std::round(p.x)), std::abs(p.y - std::round(p.y)));
}

TEST(PalletGrid, IsFoundWhereverItLiesInTheMap) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed, "walls");
    const double x = rng.uniform() * kPallet, y = rng.uniform() * kPallet, turn = 2.0 * kPi * rng.uniform();
    const TPose2D T_map_grid{x, y, turn};
    SCOPED_TRACE(testing::Message() << "seed " << seed << ": " << x << " " << y << " " << turn);
    const auto grid = find_pallets(map_of_walls(T_map_grid, rng), kPallet, {4.0, 4.0});
    ASSERT_TRUE(grid);
    for (int i = 0; i < 5; ++i)
      for (int k = 0; k < 5; ++k) {
        const TPoint2D corner = T_map_grid.composePoint(TPoint2D{(i - 2) * kPallet, (k - 2) * kPallet});
        if (distance(corner, {4.0, 4.0}) < 4.0) {
          EXPECT_LT(off_edges(*grid, corner), 0.08) << "two cells of the map are 0.1 m";
        }
        const TPoint2D again = grid->to_map(grid->to_grid(corner));
        EXPECT_NEAR(distance(again, corner), 0.0, 1e-9);
      }
  }
}

TEST(PalletGrid, IsNotMadeUpWhereNoWallsAgree) {
  Rng rng(3, "walls");
  const OccupancyGrid walls = map_of_walls({}, rng);
  EXPECT_FALSE(find_pallets(OccupancyGrid(walls.frame(), Occupancy::Free), kPallet, {4.0, 4.0}));
  OccupancyGrid noise(walls.frame(), Occupancy::Free);
  for (int i = 0; i < 3000; ++i) {
    const int x = static_cast<int>(rng.uniform() * 160.0), y = static_cast<int>(rng.uniform() * 160.0);
    noise[{x, y}] = Occupancy::Occupied;
  }
  EXPECT_FALSE(find_pallets(noise, kPallet, {4.0, 4.0}));
}

TEST(LocalGrids, ThoseOfEarlierMapsChangeNothing) {
  KnownGrids known;
  Rng rng(4, "walls");
  OccupancyGrid cells = map_of_walls({0.3, 0.5, 0.2}, rng);
  std::size_t kept = 0;
  for (int step = 0; step < 40; ++step) {
    SCOPED_TRACE(step);
    // A wall that comes or goes, now and then a map that is turned, or wider.
    const Cell at{static_cast<int>(rng.uniform() * 140.0), static_cast<int>(rng.uniform() * 140.0)};
    for (int i = 0; i < 20; ++i) cells[{at.x + i, at.y}] = step % 2 == 0 ? Occupancy::Occupied : Occupancy::Free;
    if (step % 10 == 9) cells = map_of_walls({0.1 * step, 0.5, 0.02 * step}, rng);
    if (step == 25) cells = with_frame(cells, {160, 160, 0.05, -1.2, 0.6});
    const KnownGrids before = known;
    LocalGrids fresh(cells, kPallet), again(cells, kPallet, &known);
    for (double x = -1.0; x < 9.0; x += 3.0)
      for (double y = -1.0; y < 9.0; y += 3.0) {
        const std::optional<PalletGrid>&a = fresh.at({x, y}), &b = again.at({x, y});
        ASSERT_EQ(a.has_value(), b.has_value());
        if (!a) continue;
        EXPECT_EQ(a->angle(), b->angle());
        EXPECT_EQ(a->east, b->east);
        EXPECT_EQ(a->north, b->north);
      }
    for (const auto& [tile, grid] : before) kept += known.at(tile).walls == grid.walls ? 1 : 0;
  }
  EXPECT_GT(kept, 100u) << "most were not found anew";
}

/// The grid's edges at multiples of 1.2 m; the robot drives east out of pallet (0, 0).
struct FeltPallet : testing::Test {
  PalletGrid grid;
  FeltObstacles felt;
  const TPose2D at_the_edge{1.2 - 0.5 * kRobot.length - 0.02, 0.6, 0.0};
  const TPoint2D beyond{1.8, 0.6};

  double nearest(const TPoint2D& p, double now = 10.0) const {
    double least = 1e9;
    for (const TPoint2D& q : felt.points(after(now))) least = std::min(least, distance(p, q));
    return least;
  }
};

TEST_F(FeltPallet, TheWholePalletCountsAndLeavesRoomBesideIt) {
  ASSERT_TRUE(felt.feel({after(1.0), at_the_edge}, false, kRobot, grid));
  for (double x = 1.3; x < 2.3; x += 0.1)
    for (double y = 0.1; y < 1.1; y += 0.1) EXPECT_LT(nearest({x, y}), 0.12) << x << " " << y;
  for (const TPoint2D& p : felt.points(after(10.0))) {
    EXPECT_GT(p.x, 1.2);
    EXPECT_LT(p.x, 2.4);
    EXPECT_GT(p.y, 0.0);
    EXPECT_LT(p.y, 1.2);
  }
  EXPECT_EQ(felt.count(after(1e6)), 1) << "time alone does not free a step field";
}

TEST_F(FeltPallet, APardonLeavesTheMiddlesOfTheSidesAndTheNextTouchIsForGood) {
  ASSERT_TRUE(felt.feel({after(1.0), at_the_edge}, false, kRobot, grid));
  ASSERT_TRUE(felt.pardon(after(2.0)));
  EXPECT_GT(nearest(beyond), 0.5);
  EXPECT_NEAR(nearest({1.2, 0.6}), 0.0, 1e-9) << "where a crossing ramp has a high corner";
  ASSERT_TRUE(felt.feel({after(3.0), TPose2D{1.8, 1.2 + 0.5 * kRobot.length + 0.02, -0.5 * kPi}}, false, kRobot, grid));
  EXPECT_LT(nearest(beyond), 0.12);
  EXPECT_EQ(felt.count(after(10.0)), 1) << "it is the same pallet";
  EXPECT_FALSE(felt.pardon(after(4.0)));
  EXPECT_TRUE(felt.forget(after(5.0))) << "but for the way home";
  EXPECT_EQ(felt.count(after(6.0)), 0);
}

TEST_F(FeltPallet, APalletFeltAgainAfterItWasForgottenIsNotForgottenOnceMore) {
  ASSERT_TRUE(felt.feel({after(1.0), at_the_edge}, false, kRobot, grid));
  EXPECT_TRUE(felt.forget_once(after(2.0)));
  EXPECT_EQ(felt.count(after(2.0)), 0);
  ASSERT_TRUE(felt.feel({after(3.0), at_the_edge}, false, kRobot, grid));
  EXPECT_FALSE(felt.forget_once(after(4.0)));
  EXPECT_EQ(felt.count(after(4.0)), 1);
  EXPECT_TRUE(felt.forget(after(5.0))) << "but for the way home";
}

TEST_F(FeltPallet, APalletTheRobotStoodOnIsNoStepField) {
  EXPECT_FALSE(felt.feel({after(1.0), at_the_edge}, false, kRobot, grid, {beyond}));
  EXPECT_GT(nearest({2.2, 0.6}), 0.5);
  EXPECT_EQ(felt.count(after(2.0)), 1) << "a bar stands there";

  FeltObstacles other;
  ASSERT_TRUE(other.feel({after(1.0), at_the_edge}, false, kRobot, grid));
  other.passed({beyond.x, beyond.y, 0.0}, kRobot);
  for (const TPoint2D& p : other.points(after(2.0))) EXPECT_GT(distance(p, beyond), 0.5);
}

TEST_F(FeltPallet, APalletThatHeldTheRobotAgainAndAgainIsLeftAloneOnceItIsLeft) {
  const FeltConfig config;
  const TPose2D on_it{1.7, 0.6, 0.0};
  for (int times = 1; times <= config.tries; ++times) {
    EXPECT_GT(nearest({1.5, 0.25}), 0.25) << times;
    felt.passed(on_it, kRobot);
    EXPECT_FALSE(felt.feel({after(times), on_it}, false, kRobot, grid));
  }
  felt.passed(on_it, kRobot);
  EXPECT_GT(nearest({1.5, 0.25}), 0.25) << "it must get out";
  felt.passed({0.6, 0.6, 0.0}, kRobot);
  EXPECT_LT(nearest({1.5, 0.25}), 0.12);
  felt.pardon(after(5.0));
  felt.pardon(after(6.0));
  EXPECT_LT(nearest({1.5, 0.25}), 0.12);
  EXPECT_TRUE(felt.forget(after(7.0))) << "but for the way home";
  EXPECT_EQ(felt.count(after(8.0)), 0);
}

/// Before its middle lies its own pallet, but a corner has met the edge of the next.
TEST_F(FeltPallet, WhatACornerMetIsThePalletBeforeThatCorner) {
  const TPose2D askew{0.75, 0.35, deg_to_rad(-40.0)};
  const TPoint2D below{0.6, -0.6};
  ASSERT_TRUE(felt.feel({after(1.0), askew}, false, kRobot, grid));
  EXPECT_LT(nearest(below), 0.12);
  EXPECT_GT(nearest({1.8, 0.6}), 0.5) << "the other corner is farther from the edge";

  const std::vector<TPoint2D> stood_there = {below};
  FeltObstacles flat;
  EXPECT_FALSE(flat.feel({after(1.0), askew}, false, kRobot, grid, stood_there));

  GridFrame frame;
  frame.resolution = 0.05;
  frame.width = frame.height = 100;
  frame.x0 = frame.y0 = -2.0;
  OccupancyGrid wall(frame, Occupancy::Free);
  for (int x = 0; x < frame.width; ++x) wall[{x, frame.cell({0.0, 0.0}).y}] = Occupancy::Occupied;
  FeltObstacles walled;
  EXPECT_FALSE(walled.feel({after(1.0), askew}, false, kRobot, grid, {}, &wall)) << "nothing reaches through a wall";
}

TEST_F(FeltPallet, WhereCornersReachIntoTwoPalletsNeitherIsMeant) {
  const TPose2D in_the_corner{0.87, 0.87, deg_to_rad(45.0)};
  const double reach = 0.5 * kRobot.length + 0.1;
  ASSERT_LT(in_the_corner.composePoint(TPoint2D{reach, 0.0}).x, 1.2) << "the middle of its front is on its own";
  ASSERT_GT(in_the_corner.composePoint(TPoint2D{reach, -0.2}).x, 1.2);
  EXPECT_FALSE(felt.feel({after(1.0), in_the_corner}, false, kRobot, grid));
}

TEST_F(FeltPallet, OnAPalletWithStepsACornerMeetsThatPalletsOwn) {
  const TPose2D askew{0.75, 0.35, deg_to_rad(-40.0)};
  EXPECT_FALSE(felt.feel({after(1.0), TPose2D{0.6, 0.6, 0.0}}, false, kRobot, grid)) << "a step on its own pallet";
  EXPECT_FALSE(felt.feel({after(2.0), askew}, false, kRobot, grid));
  EXPECT_GT(nearest({0.6, -0.6}), 0.5);
}

/// It was let go of, and holds the robot: there are steps on it after all.
TEST_F(FeltPallet, APardonedPalletThatHoldsTheRobotIsATrapAndIsLeftAloneOnceItIsLeft) {
  const TPose2D on_it{1.8, 0.6, 0.0}, before_it{0.6, 0.6, 0.0};
  EXPECT_FALSE(felt.trap(on_it)) << "nothing was felt there";
  ASSERT_TRUE(felt.feel({after(1.0), at_the_edge}, false, kRobot, grid));
  EXPECT_FALSE(felt.trap(on_it)) << "it was not let go of";
  ASSERT_TRUE(felt.pardon(after(2.0)));
  EXPECT_FALSE(felt.trap(before_it));
  felt.passed(on_it, kRobot);
  EXPECT_GT(nearest(beyond), 0.5) << "it may be driven on";
  const auto trap = felt.trap(on_it);
  ASSERT_TRUE(trap);
  EXPECT_TRUE(trap->holds({1.25, 1.15}));
  EXPECT_FALSE(trap->holds({1.15, 0.6}));
  EXPECT_TRUE(trap->holds({1.15, 0.6}, 0.1));
  EXPECT_GT(nearest(beyond), 0.5) << "it must get out";
  felt.passed(before_it, kRobot);
  EXPECT_LT(nearest(beyond), 0.12);
  felt.pardon(after(5.0));
  felt.pardon(after(6.0));
  EXPECT_LT(nearest(beyond), 0.12) << "it had its pardon";
  EXPECT_TRUE(felt.forget_once(after(7.0)));
  EXPECT_EQ(felt.count(after(8.0)), 0);
  EXPECT_TRUE(felt.trap(on_it)) << "and traps it the next time again";
}

/// It drove in without a blow, and does not get out: what was met there, or before, was no edge of that pallet.
TEST_F(FeltPallet, APalletThatItDidNotGetFreeOfIsATrap) {
  const TPose2D on_it{1.8, 0.6, 0.0}, before_it{0.6, 0.6, 0.0};
  felt.passed(on_it, kRobot);
  felt.not_got_free({after(1.0), on_it}, grid);
  EXPECT_FALSE(felt.trap(before_it));
  const auto trap = felt.trap(on_it);
  ASSERT_TRUE(trap);
  EXPECT_TRUE(trap->holds({1.25, 1.15}));
  EXPECT_GT(nearest(beyond), 0.5) << "it must get out";
  felt.passed(before_it, kRobot);
  EXPECT_LT(nearest(beyond), 0.12) << "it is left alone";
  felt.not_got_free({after(2.0), before_it}, grid);
  EXPECT_TRUE(felt.trap(before_it));
  EXPECT_EQ(felt.count(after(3.0)), 2);
}

TEST_F(FeltPallet, WhatIsMetWithinAPalletOrBehindTheRobotStaysThere) {
  EXPECT_FALSE(felt.feel({after(1.0), TPose2D{0.5, 0.6, 0.0}}, false, kRobot, grid)) << "the middle of its own pallet";
  FeltObstacles behind;
  ASSERT_TRUE(behind.feel({after(1.0), TPose2D{at_the_edge.x, 0.6, kPi}}, true, kRobot, grid));
  for (const TPoint2D& p : behind.points(after(2.0))) EXPECT_GT(p.x, 1.2);
}

}  // namespace
}  // namespace rubble::explore
