#include "explore/caution/felt_obstacles.h"

#include <gtest/gtest.h>

#include "base/angle.h"
#include "base/planar.h"
#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

const robot::RobotModel kModel;

Stamp at(double seconds) { return Stamp::from_seconds(seconds); }

double nearest(const std::vector<TPoint2D>& points, const TPoint2D& p) {
  double least = 1e9;
  for (const TPoint2D& q : points) least = std::min(least, distance(p, q));
  return least;
}

TEST(FeltObstacles, StandBeforeTheBodyThatFeltThem) {
  FeltObstacles felt;
  felt.feel({at(1.0), TPose2D{2.0, 3.0, deg_to_rad(90.0)}}, false, kModel);
  const std::vector<TPoint2D> points = felt.points(at(2.0));
  ASSERT_FALSE(points.empty());
  for (const TPoint2D& p : points) {
    EXPECT_GT(p.y, 3.0 + 0.5 * kModel.length);
    EXPECT_LT(p.y, 3.0 + 0.5 * kModel.length + 0.2);
    EXPECT_LT(std::abs(p.x - 2.0), 0.5 * kModel.width);
  }
}

TEST(FeltObstacles, StandBehindTheBodyThatDroveBackwards) {
  FeltObstacles felt;
  felt.feel({at(1.0), TPose2D{2.0, 3.0, 0.0}}, true, kModel);
  for (const TPoint2D& p : felt.points(at(2.0))) EXPECT_LT(p.x, 2.0 - 0.5 * kModel.length);
}

TEST(FeltObstacles, AreForgottenLaterTheMoreOftenTheyWereFeltAndInTheEndNever) {
  FeltConfig config;
  FeltObstacles felt(config);
  double now = 0.0;
  double last_memory = 0.0;
  for (int times = 1; times < config.certain; ++times) {
    felt.feel({at(now), TPose2D{}}, false, kModel);
    double memory = 0.0;
    while (felt.count(at(now + memory)) > 0) memory += 1.0;
    EXPECT_GT(memory, last_memory);
    last_memory = memory;
    now += memory + 1.0;
  }
  felt.feel({at(now), TPose2D{}}, false, kModel);
  EXPECT_EQ(felt.count(at(now + 1e6)), 1);
}

TEST(FeltObstacles, WhatIsFeltElsewhereIsAnotherThing) {
  FeltConfig config;
  FeltObstacles felt(config);
  for (int i = 0; i < 5; ++i) felt.feel({at(0.0), TPose2D{2.0 * i, 0.0, 0.0}}, false, kModel);
  EXPECT_EQ(felt.count(at(0.5 * config.memory)), 5);
  EXPECT_EQ(felt.count(at(1.5 * config.memory)), 0);
}

TEST(FeltObstacles, PardonLeavesALaneBesideAThingBeforeItForgetsIt) {
  FeltObstacles felt;
  felt.feel({at(0.0), TPose2D{}}, false, kModel);
  const std::size_t wide = felt.points(at(1.0)).size();
  EXPECT_TRUE(felt.pardon(at(1.0)));
  EXPECT_LT(felt.points(at(1.0)).size(), wide);
  EXPECT_EQ(felt.count(at(1.0)), 1);
  EXPECT_TRUE(felt.pardon(at(2.0)));
  EXPECT_EQ(felt.count(at(2.0)), 0);
  EXPECT_FALSE(felt.pardon(at(3.0)));
}

TEST(FeltObstacles, ForgettingTakesTheCertainOnesToo) {
  const FeltConfig config;
  FeltObstacles felt(config);
  for (int i = 0; i < config.certain; ++i) felt.feel({at(0.0), TPose2D{}}, false, kModel);
  EXPECT_TRUE(felt.forget(at(1.0)));
  EXPECT_EQ(felt.count(at(1.0)), 0);
  EXPECT_FALSE(felt.forget(at(1.0)));
  felt.feel({at(2.0), TPose2D{}}, false, kModel);
  EXPECT_EQ(felt.count(at(3.0)), 1);
}

TEST(FeltObstacles, EachThingIsForgottenOnceForTheSakeOfNewGround) {
  FeltObstacles felt;
  felt.feel({at(0.0), TPose2D{}}, false, kModel);
  EXPECT_TRUE(felt.forget_once(at(1.0)));
  EXPECT_EQ(felt.count(at(1.0)), 0);
  EXPECT_FALSE(felt.forget_once(at(1.0)));
  felt.feel({at(2.0), TPose2D{0.1, 0.0, 0.0}}, false, kModel);  // it was no mistake
  felt.feel({at(2.0), TPose2D{5.0, 0.0, 0.0}}, false, kModel);  // another
  EXPECT_TRUE(felt.forget_once(at(3.0)));
  EXPECT_EQ(felt.count(at(3.0)), 1) << "what was felt again stays";
  EXPECT_FALSE(felt.forget_once(at(4.0)));
  EXPECT_TRUE(felt.forget(at(5.0))) << "but for the way home";
  EXPECT_EQ(felt.count(at(5.0)), 0);
}

TEST(FeltObstacles, PardonSparesWhatIsCertain) {
  FeltConfig config;
  FeltObstacles felt(config);
  felt.feel({at(0.0), TPose2D{5.0, 0.0, 0.0}}, false, kModel);
  for (int i = 0; i < config.certain; ++i) felt.feel({at(0.0), TPose2D{}}, false, kModel);
  EXPECT_TRUE(felt.pardon(at(1.0)));
  EXPECT_TRUE(felt.pardon(at(1.0)));
  const std::vector<TPoint2D> left = felt.points(at(2.0));
  EXPECT_LT(nearest(left, {0.5 * kModel.length + 0.1, 0.0}), 1e-6);
  EXPECT_GT(nearest(left, {5.0 + 0.5 * kModel.length + 0.1, 0.0}), 1.0);
  EXPECT_FALSE(felt.pardon(at(3.0)));
}

TEST(FeltObstacles, AreGoneWhereTheRobotStoodInGoodOrder) {
  FeltObstacles felt;
  felt.feel({at(0.0), TPose2D{}}, false, kModel);
  felt.passed(TPose2D{-0.3, 0.0, 0.0}, kModel);
  EXPECT_EQ(felt.count(at(1.0)), 1);
  felt.passed(TPose2D{0.5 * kModel.length + 0.1, 0.0, 1.0}, kModel);
  EXPECT_EQ(felt.count(at(1.0)), 0);
}

/// Of a red field of steps the laser sees the higher ones, from corner to corner; the lower ones hold a robot that has
/// come onto it, which are not the floor of the pallet before it.
TEST(FeltObstacles, AmongStepsThePalletItStandsOnIsToBlameNotTheNext) {
  PalletGrid grid;
  const TPose2D pose{2.1, 0.8, 0.0};  // its front reaches over the edge at 2.4
  const TPoint2D own{1.8, 0.6}, next{3.0, 0.6};
  for (const bool shows : {false, true}) {
    OccupancyGrid known = test::room(6.0, 4.0);
    for (double d = 0.2; shows && d < 1.0; d += 0.05)
      test::fill(known, 1.2 + d - 0.04, d - 0.04, 1.2 + d + 0.04, d + 0.04, Occupancy::Occupied);
    FeltObstacles felt;
    felt.feel({at(1.0), pose}, false, kModel, grid, {}, &known);
    EXPECT_EQ(nearest(felt.points(at(2.0)), next) < 0.1, !shows);
    felt.passed({4.0, 3.0, 0.0}, kModel);  // it is off it
    EXPECT_EQ(nearest(felt.points(at(2.0)), own) < 0.1, shows) << "then it is left alone";
  }
}

/// On its way round the corner of a field its wheel met the outermost step, and the lane before it was left alone: the
/// only one to two fifths of a red arena.
TEST(FeltObstacles, AStepFieldBesideACornerIsToBlameUnlessItIsKeptClearOf) {
  const PalletGrid grid;
  const TPose2D cuts_corner{2.25, 1.15, deg_to_rad(-51.0)};  // four pallets meet at (2.4, 1.2)
  const TPoint2D lane{3.0, 0.6}, field{3.0, 1.8};
  const std::vector<TPoint2D> trail{{1.8, 1.8}, {1.8, 0.6}};
  for (const bool shows : {false, true}) {
    OccupancyGrid known = test::room(6.0, 4.0);
    for (double d = 0.2; shows && d < 1.0; d += 0.05)
      test::fill(known, 2.4 + d - 0.04, 2.4 - d - 0.04, 2.4 + d + 0.04, 2.4 - d + 0.04, Occupancy::Occupied);
    FeltObstacles felt;
    EXPECT_TRUE(felt.feel({at(1.0), cuts_corner}, false, kModel, grid, trail, &known, true));
    EXPECT_EQ(nearest(felt.points(at(2.0)), field) < 0.1, shows);
    EXPECT_EQ(nearest(felt.points(at(2.0)), lane) < 0.1, !shows);
    felt.feel({at(3.0), cuts_corner}, false, kModel, grid, trail, &known, true);
    EXPECT_LT(nearest(felt.points(at(4.0)), lane), 0.1) << "it kept clear of the field and was struck all the same";
  }
}

/// Steps are not crossed however often they are tried, and crossing ramps let the robot in and not out again.
TEST(FeltObstacles, APalletThatStruckTheBodyIsNotPardonedButForgottenOnce) {
  const PalletGrid grid;
  const TPoint2D middle{3.0, 0.6};
  for (const bool sure : {false, true}) {
    FeltObstacles felt;
    EXPECT_TRUE(felt.feel({at(0.0), {2.1, 0.6, 0.0}}, false, kModel, grid, {}, nullptr, sure));
    EXPECT_EQ(felt.pardon(at(1.0)), !sure);
    EXPECT_EQ(nearest(felt.points(at(2.0)), middle) < 0.1, sure);
    felt.forget_once(at(3.0));
    EXPECT_GT(nearest(felt.points(at(4.0)), middle), 0.1);
  }
}

/// Aslant beside the corner where four pallets meet, the front reaches into one and a corner of the body into another:
/// a field of steps in that one shut the only lane to a third of an arena.
TEST(FeltObstacles, WhereACornerMayHaveMetAnotherPalletNeitherIsShut) {
  const PalletGrid grid;
  const TPose2D aslant{2.34, 1.38, deg_to_rad(-114.0)};  // on the pallet at 1.8, 1.8
  const TPoint2D ahead{1.8, 0.6}, other{3.0, 0.6};
  const auto shut = [&](const FeltObstacles& felt, const TPoint2D& middle) {
    return nearest(felt.points(at(2.0)), middle) < 0.1;
  };

  FeltObstacles felt;
  EXPECT_FALSE(felt.feel({at(1.0), aslant}, false, kModel, grid));
  EXPECT_EQ(felt.count(at(2.0)), 1) << "it is a bar";
  EXPECT_FALSE(shut(felt, ahead));
  EXPECT_FALSE(shut(felt, other));

  FeltObstacles knows_other;
  EXPECT_TRUE(knows_other.feel({at(0.0), {3.0, 1.45, deg_to_rad(-90.0)}}, false, kModel, grid));
  EXPECT_TRUE(knows_other.feel({at(1.0), aslant}, false, kModel, grid)) << "it is that again";
  EXPECT_FALSE(shut(knows_other, ahead));
  EXPECT_TRUE(shut(knows_other, other));

  OccupancyGrid walled = test::room(6.0, 4.0);
  test::fill(walled, 2.4, 0.0, 2.45, 1.2, Occupancy::Occupied);
  FeltObstacles sees_a_wall;
  EXPECT_TRUE(sees_a_wall.feel({at(1.0), aslant}, false, kModel, grid, {}, &walled)) << "no corner reaches through it";
  EXPECT_TRUE(shut(sees_a_wall, ahead));

  FeltObstacles was_there;
  EXPECT_TRUE(was_there.feel({at(1.0), aslant}, false, kModel, grid, {other}, nullptr)) << "it can be driven on";
  EXPECT_TRUE(shut(was_there, ahead));

  FeltObstacles was_ahead;
  EXPECT_TRUE(was_ahead.feel({at(1.0), aslant}, false, kModel, grid, {ahead}, nullptr));
  EXPECT_FALSE(shut(was_ahead, ahead));
  EXPECT_TRUE(shut(was_ahead, other)) << "it is the only one left";
}

}  // namespace
}  // namespace rubble::explore
