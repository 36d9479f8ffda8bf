#include "explore/paper/target_choice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "base/planar.h"
#include "explore/paper/plan_clock.h"
#include "tests/support/explore_grids.h"
#include "tests/support/planted_mapper.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/// A robot in a room of 8 x 4 m, with unknown ground where a test puts it.
struct Choosing {
  explicit Choosing(bool searches = false, bool bar_targets = true, const PlannerConfig& planner = {},
                    const Priorities& priorities = {})
      : choice(planner, bar_targets, 0.0, {}, priorities) {
    config.on = searches;
    search.emplace(config, 0.46, 0.4);
  }
  /// The room becomes a corridor along y = 0.65, with the robot in it.
  void narrow() {
    cells = test::room(8.0, 1.3);
    pose.y = 0.65;
  }
  void unknown(double x, double y) { test::fill(cells, x, y, x + 0.4, y + 0.4, Occupancy::Unknown); }
  TargetChoice::View view() {
    floor = test::measured(cells);
    return {floor, pose, now, left_alone};
  }
  TargetChoice::Choice choose() { return choice.choose(view(), *search); }

  OccupancyGrid cells = test::room(8.0, 4.0);
  Traversable floor;
  TPose2D pose{4.0, 2.0, 0.0};
  Stamp now = Stamp::from_seconds(1.0);
  LeftAlone left_alone{FeltConfig{}, PlannerConfig{}.same_target};
  SearchConfig config;
  std::optional<FloorSearch> search;
  TargetChoice choice;
};

TEST(TargetChoice, DrivesToTheNearestFrontier) {
  Choosing robot;
  robot.narrow();
  EXPECT_FALSE(robot.choose().plan.found) << "all is known";
  robot.unknown(6.5, 0.45);
  robot.unknown(0.6, 0.45);
  const Plan plan = robot.choose().plan;
  ASSERT_TRUE(plan.found);
  EXPECT_GT(plan.target.x, 5.0);
  EXPECT_EQ(plan.frontier_left, 2u);
  EXPECT_EQ(robot.choice.goal(), Goal::Frontier);
}

TEST(TargetChoice, TheTargetBeingDrivenToHasAHeadStart) {
  Choosing robot;
  robot.unknown(6.5, 1.8);
  robot.unknown(1.1, 1.8);
  robot.pose.x = 3.9;
  const Plan first = robot.choose().plan;
  ASSERT_TRUE(first.found);
  ASSERT_LT(first.target.x, 4.0);
  EXPECT_TRUE(robot.choice.take(first));
  robot.pose.x = 4.1;
  EXPECT_LT(robot.choose().plan.target.x, 4.0);
  robot.choice.drop_target();
  EXPECT_GT(robot.choose().plan.target.x, 4.0);
}

TEST(TargetChoice, WhatIsBarredIsNoTargetUnlessNothingIsEverBarred) {
  for (const bool bar_targets : {true, false}) {
    Choosing robot(false, bar_targets);
    robot.unknown(6.5, 1.8);
    robot.left_alone.bar_for_good({6.5, 2.0}, {robot.now, robot.pose});
    EXPECT_EQ(robot.choose().plan.found, !bar_targets);
  }
}

TEST(TargetChoice, ATargetStaysTheSameWhileItMovesALittle) {
  Choosing robot;
  Plan plan;
  plan.found = true;
  plan.target = {6.0, 2.0};
  plan.cost = 3.0;
  EXPECT_FALSE(robot.choice.turns_away(plan)) << "from none";
  EXPECT_TRUE(robot.choice.take(plan));
  plan.target.x += 0.4;
  plan.cost = 2.0;
  EXPECT_FALSE(robot.choice.turns_away(plan));
  EXPECT_FALSE(robot.choice.take(plan));
  EXPECT_EQ(robot.choice.cost(), 3.0) << "as when it was first chosen";
  plan.target.x += 0.6;
  EXPECT_TRUE(robot.choice.turns_away(plan));
  EXPECT_TRUE(robot.choice.take(plan));
  EXPECT_EQ(robot.choice.cost(), 2.0);
}

TEST(TargetChoice, AWallAcrossTheWayKeepsTheRobotAway) {
  Choosing robot;
  robot.narrow();
  Plan plan;
  plan.found = true;
  plan.target = {7.0, 0.65};
  robot.choice.take(plan);
  EXPECT_FALSE(robot.choice.kept_away(robot.view(), 3.0));
  test::fill(robot.cells, 5.0, 1.1, 5.1, 1.3, Occupancy::Occupied);
  EXPECT_FALSE(robot.choice.kept_away(robot.view(), 3.0)) << "beside the way";
  test::fill(robot.cells, 5.0, 0.0, 5.1, 1.3, Occupancy::Occupied);
  EXPECT_TRUE(robot.choice.kept_away(robot.view(), 3.0));
}

TEST(TargetChoice, OnceFrontiersAreDonePlacesAreSearchedNichesFirst) {
  Choosing robot(true);
  robot.choice.set_frontiers_done();
  robot.choice.search();
  TargetChoice::Choice choice = robot.choose();
  ASSERT_TRUE(choice.no_niche);
  choice = robot.choice.choose_of_all_places(robot.view(), *robot.search, std::move(choice.plan));
  EXPECT_TRUE(choice.plan.found);
  EXPECT_EQ(robot.choice.goal(), Goal::Place);
  for (const double x : {6.0, 6.4}) test::fill(robot.cells, x, 3.4, x + 0.1, 4.0, Occupancy::Occupied);
  choice = robot.choose();
  EXPECT_FALSE(choice.no_niche);
  ASSERT_TRUE(choice.plan.found);
  EXPECT_NEAR(choice.plan.target.x, 6.2, 0.5);
}

/// All was looked at, but a face only from the side: that is a target where holes are expected.
TEST(TargetChoice, FacesAreLookedAtSquarelyInTheEndWhereHolesAreExpected) {
  Choosing robot(true);
  robot.narrow();
  robot.choice.set_frontiers_done();
  robot.choice.search();
  robot.view();
  // Each wall from 0.5 m away: too near to look through a hole.
  for (double x = 0.1; x < 7.95; x += 0.1)
    for (double heading = 0.0; heading < 2.0 * kPi; heading += 0.2)
      for (int looks = 0; looks < 2; ++looks)
        robot.search->look(robot.floor, {x, heading < kPi ? 0.8 : 0.5, heading}, 0.0, robot.now = robot.now + 1.0);
  const auto choose_place = [&] { return robot.choice.choose_of_all_places(robot.view(), *robot.search, Plan{}).plan; };
  EXPECT_FALSE(choose_place().found);
  robot.search->expect_holes();
  EXPECT_TRUE(choose_place().found);
}

/// Each look from where it shows the most of what is left, a panel of wall as a rule: led to the nearest face that was
/// not looked at, the robot would creep along beside it, a hand's breadth a look.
TEST(TargetChoice, ALookSquarelyShowsAFootOfWallInTheMean) {
  Choosing robot(true);
  robot.narrow();
  robot.choice.set_frontiers_done();
  robot.choice.search();
  robot.search->expect_holes();
  int looks = 0;
  for (; looks < 200; ++looks) {
    const Plan plan = robot.choice.choose_of_all_places(robot.view(), *robot.search, Plan{}).plan;
    if (!plan.found) break;
    robot.choice.take(plan);
    robot.pose = {plan.target.x, plan.target.y, robot.pose.phi};
    if (const auto turn = robot.search->turn_to_subject(robot.floor, robot.pose)) robot.pose.phi += *turn;
    for (int i = 0; i < 2; ++i) robot.search->look(robot.floor, robot.pose, 0.0, robot.now = robot.now + 1.0);
    robot.search->start_dwell(robot.now);
    robot.search->dwelling(robot.floor, robot.pose, robot.now = robot.now + 5.0);
  }
  EXPECT_LT(looks, 2 * 8.0 / 0.33);
  EXPECT_GT(looks, 2 * 8.0 / 1.0);
}

/// Half a metre of wall that was left beside the robot does not keep it from the lane that nobody has looked at; but it
/// is looked at in the end, and its way costs what it is long.
TEST(TargetChoice, ScrapsOfWallAreLookedAtLast) {
  Choosing robot(true);
  robot.narrow();
  robot.pose.x = 4.6;
  robot.choice.set_frontiers_done();
  robot.choice.search();
  robot.search->expect_holes();
  robot.view();
  const auto look = [&](double from, double to, double heading) {
    for (double x = from; x < to; x += 0.05)
      for (int looks = 0; looks < 2; ++looks)
        robot.search->look(robot.floor, {x, 0.65 - 0.25 * std::sin(heading), heading}, 0.0,
                           robot.now = robot.now + 1.0);
  };
  const auto choose_place = [&] { return robot.choice.choose_of_all_places(robot.view(), *robot.search, Plan{}).plan; };
  for (const double heading : {0.0, kPi}) look(0.4, 7.6, heading);
  look(2.5, 7.9, -0.5 * kPi);
  look(2.5, 4.95, 0.5 * kPi);
  look(6.15, 7.9, 0.5 * kPi);
  const Plan lane = choose_place();
  ASSERT_TRUE(lane.found);
  EXPECT_LT(lane.target.x, 3.0);
  look(0.1, 2.5, -0.5 * kPi);
  look(0.1, 2.5, 0.5 * kPi);
  const Plan scrap = choose_place();
  ASSERT_TRUE(scrap.found);
  EXPECT_NEAR(scrap.target.x, 5.5, 0.6);
  EXPECT_LT(scrap.cost, 5.0);
}

/// The scanner saw a hole in the wall farther on: the board around it, which may have more of them higher up, is looked
/// at before the solid wall beside the robot.
TEST(TargetChoice, ABoardWithAHoleThatWasSeenIsLookedAtFirst) {
  for (const bool hole : {false, true}) {
    Choosing robot(true);
    robot.narrow();
    robot.choice.set_frontiers_done();
    robot.choice.search();
    robot.search->expect_holes();
    if (hole) test::fill(robot.cells, 6.1, 1.2, 6.3, 1.35, Occupancy::Free);
    const Plan plan = robot.choice.choose_of_all_places(robot.view(), *robot.search, Plan{}).plan;
    ASSERT_TRUE(plan.found);
    EXPECT_EQ(std::abs(plan.target.x - 6.2) < 1.2, hole) << plan.target.x;
  }
}

/// The steps of a field show like the sides of boxes.
TEST(TargetChoice, NoNicheIsLookedForAmongSteps) {
  for (const bool steps : {false, true}) {
    Choosing robot(true);
    robot.choice = TargetChoice({}, true, test::kPallet);
    robot.cells = test::corridor_of_pallets(9.0, test::kPallet, Occupancy::Free);
    robot.pose = {2.0, 0.6, 0.0};
    for (const double side : {-0.25, 0.15})  // at the south wall
      test::fill(robot.cells, 4.2 + side, 0.0, 4.3 + side, 0.42, Occupancy::Occupied);
    for (double at = 0.25; steps && at < 1.0; at += 0.2)
      test::fill(robot.cells, 3.6 + at, at, 3.7 + at, at + 0.1, Occupancy::Occupied);
    robot.choice.set_frontiers_done();
    robot.choice.search();
    EXPECT_EQ(robot.choose().no_niche, steps);
  }
}

/// A field of steps begins on the edge of its pallet: scans meet its steps now and then, and it is no wall to be looked
/// at squarely. A wall before it is one.
TEST(TargetChoice, TheEdgeOfAFieldOfStepsIsNoWall) {
  for (const bool wall : {false, true}) {
    Choosing robot(true);
    robot.choice = TargetChoice({}, true, test::kPallet);
    robot.cells = test::corridor_of_pallets(9.0, test::kPallet, Occupancy::Free);
    robot.pose = {2.0, 0.6, 0.0};
    const double west = 2.0 * test::kPallet, edge = test::kPallet;
    for (double at = 0.15; at < 1.1; at += 0.2)
      test::fill(robot.cells, west + at, edge + at, west + at + 0.11, edge + at + 0.11, Occupancy::Occupied);
    robot.choice.set_frontiers_done();
    robot.choice.search();
    robot.search->expect_holes();
    bool squarely = false;
    for (int looks = 0; looks < 100; ++looks) {
      const TargetChoice::View view = robot.view();
      for (double x = west + 0.075; x < west + 1.15; x += 0.05)
        for (const double y : {edge - 0.025, edge + 0.025})
          robot.floor.unsure[robot.floor.cells.cell({x, y})] = wall ? 0 : 1;
      const Plan plan = robot.choice.choose_of_all_places(view, *robot.search, Plan{}).plan;
      if (!plan.found) break;
      robot.choice.take(plan);
      robot.pose = {plan.target.x, plan.target.y, robot.pose.phi};
      if (const auto turn = robot.search->turn_to_subject(robot.floor, robot.pose)) robot.pose.phi += *turn;
      const double ahead = (edge - robot.pose.y) / std::tan(robot.pose.phi);
      squarely = squarely || (std::sin(robot.pose.phi) > 0.95 && std::abs(robot.pose.x + ahead - west - 0.6) < 0.4);
      for (int i = 0; i < 2; ++i) robot.search->look(robot.floor, robot.pose, 0.0, robot.now = robot.now + 1.0);
      robot.search->start_dwell(robot.now);
      robot.search->dwelling(robot.floor, robot.pose, robot.now = robot.now + 5.0);
    }
    EXPECT_EQ(squarely, wall);
  }
}

/// Until the faces were searched, once nothing else was in reach.
TEST(TargetChoice, PocketsOfUnknownGroundCanBeLeft) {
  Choosing robot(true);
  robot.narrow();
  robot.unknown(5.3, 0.45);
  EXPECT_TRUE(robot.choose().plan.found);
  robot.choice.leave_pockets(true);
  EXPECT_FALSE(robot.choose().plan.found);
  test::fill(robot.cells, 0.6, 0.3, 1.5, 1.1, Occupancy::Unknown);
  EXPECT_LT(robot.choose().plan.target.x, 3.0) << "more than a pocket";
  robot.choice.leave_pockets(false);
  EXPECT_GT(robot.choose().plan.target.x, 3.0) << "the nearer one";
}

TEST(TargetChoice, AFrontierThatComesIntoReachGoesBeforeTheSearch) {
  Choosing robot(true);
  robot.narrow();
  robot.choice.set_frontiers_done();
  robot.choice.search();
  robot.unknown(5.2, 0.45);
  TargetChoice::Choice choice = robot.choose();
  ASSERT_TRUE(choice.no_niche);
  choice = robot.choice.choose_of_all_places(robot.view(), *robot.search, std::move(choice.plan));
  EXPECT_TRUE(choice.into_reach);
  EXPECT_EQ(robot.choice.goal(), Goal::Frontier);
  EXPECT_TRUE(robot.choice.frontiers_done()) << "it is a detour of the search";
  robot.choice.explore();
  EXPECT_FALSE(robot.choice.frontiers_done());
}

TEST(TargetChoice, ANicheIsLookedIntoWhereItLiesBesideTheWay) {
  for (const double x : {4.0, 1.0}) {
    Choosing robot(true);
    robot.unknown(7.0, 1.8);
    for (const double side : {-0.25, 0.15})
      test::fill(robot.cells, x + side, 3.4, x + side + 0.1, 4.0, Occupancy::Occupied);
    robot.pose.y = 2.8;
    const Plan plan = robot.choose().plan;
    ASSERT_TRUE(plan.found);
    EXPECT_EQ(robot.choice.goal(), x == 4.0 ? Goal::Place : Goal::Frontier) << "the niche is at " << x;
  }
}

/// A niche beside the way, as above; and walls alone, none of which was looked at.
TEST(TargetChoice, PrioritiesSayWhatIsLookedAtBeforeTheNextFrontier) {
  const auto goal = [](const Priorities& priorities, bool niche) {
    Choosing robot(true, true, {}, priorities);
    robot.unknown(7.0, 1.8);
    for (const double side : {-0.25, 0.15})
      if (niche) test::fill(robot.cells, 4.0 + side, 3.4, 4.1 + side, 4.0, Occupancy::Occupied);
    robot.pose.y = 2.8;
    EXPECT_TRUE(robot.choose().plan.found);
    return robot.choice.goal();
  };
  Priorities priorities;
  EXPECT_EQ(goal(priorities, true), Goal::Place);
  EXPECT_EQ(goal(priorities, false), Goal::Frontier);
  priorities.niches = 0.0;
  EXPECT_EQ(goal(priorities, true), Goal::Frontier);
  priorities.faces = 1.0;
  EXPECT_EQ(goal(priorities, false), Goal::Place);
}

TEST(TargetChoice, PrioritiesSayHowFarAFrontierMayCallAwayFromTheSearch) {
  for (const double frontiers : {0.0, 5.0}) {
    Priorities priorities;
    priorities.frontiers = frontiers;
    Choosing robot(true, true, {}, priorities);
    robot.narrow();
    robot.choice.set_frontiers_done();
    robot.choice.search();
    robot.unknown(6.5, 0.45);
    TargetChoice::Choice choice = robot.choose();
    choice = robot.choice.choose_of_all_places(robot.view(), *robot.search, std::move(choice.plan));
    EXPECT_EQ(robot.choice.goal(), frontiers > 0.0 ? Goal::Frontier : Goal::Place);
  }
}

/// Costs as printed know no head starts: the place that is nearer by a trifle is taken, whatever it was driving to.
TEST(TargetChoice, AsPrintedNoPlaceHasAHeadStart) {
  for (const Discomfort discomfort : {Discomfort::PerMetre, Discomfort::PerCell}) {
    PlannerConfig planner;
    planner.transform.discomfort = discomfort;
    planner.transform.alpha = 0.0;
    Choosing robot(true, true, planner);
    for (const double x : {2.0, 6.0})
      for (const double side : {-0.25, 0.15})
        test::fill(robot.cells, x + side, 3.4, x + side + 0.1, 4.0, Occupancy::Occupied);
    robot.choice.set_frontiers_done();
    robot.choice.search();
    robot.pose = {3.85, 2.8, 0.0};
    const Plan west = robot.choose().plan;
    ASSERT_TRUE(west.found);
    ASSERT_LT(west.target.x, 4.0);
    robot.choice.take(west);
    robot.pose.x = 4.15;
    EXPECT_EQ(robot.choose().plan.target.x < 4.0, discomfort == Discomfort::PerMetre);
  }
}

TEST(TargetChoice, GoesHomeToWhereItStartedAlsoAfterTheMapWasCorrected) {
  Choosing robot;
  test::PlantedMapper mapper;
  mapper.plant(Stamp::from_seconds(0.5), {1.0, 1.0, 0.0});
  robot.choice.set_home({Stamp::from_seconds(0.5), {1.0, 1.0, 0.0}});
  EXPECT_NEAR(robot.choice.distance_home(robot.pose), std::hypot(3.0, 1.0), 1e-9);
  robot.unknown(6.5, 1.8);
  robot.choice.take(robot.choose().plan);
  robot.choice.go_home();
  EXPECT_FALSE(robot.choice.target());
  const auto way_home = [&] {
    const TargetChoice::View view = robot.view();
    return robot.choice.way_home(view.floor, view.T_map_base, nullptr);
  };
  Plan plan = way_home();
  ASSERT_TRUE(plan.found);
  EXPECT_LT(distance(plan.target, {1.0, 1.0}), 0.2);
  mapper.correct(Stamp::from_seconds(9.0), {0.0, 2.0, 0.0});
  robot.choice.follow(mapper);
  plan = way_home();
  ASSERT_TRUE(plan.found);
  EXPECT_LT(distance(plan.target, {1.0, 3.0}), 0.2);
  test::fill(robot.cells, 0.7, 2.7, 1.3, 3.3, Occupancy::Occupied);
  plan = way_home();
  ASSERT_TRUE(plan.found) << "as near as can be";
  EXPECT_LT(distance(plan.target, {1.0, 3.0}), 0.85);
}

TEST(PlanClock, AsksForAPlanOnANewMapAfterAWhileOrAtOnce) {
  const auto at = [](double s) { return Stamp::from_seconds(s); };
  PlanClock clock;
  EXPECT_TRUE(clock.due(0, at(0.0))) << "the first one";
  EXPECT_TRUE(clock.plan(1, 0.5, at(1.0)));
  EXPECT_FALSE(clock.due(2, at(1.4)));
  EXPECT_TRUE(clock.due(2, at(1.5)));
  EXPECT_FALSE(clock.due(1, at(9.0))) << "the same map";
  EXPECT_NEAR(clock.age(at(1.3)), 0.3, 1e-9);
  clock.force();
  EXPECT_TRUE(clock.due(1, at(1.1)));
  EXPECT_FALSE(clock.plan(1, 0.5, at(1.1))) << "no new map";
  EXPECT_FALSE(clock.due(1, at(1.2)));
}

}  // namespace
}  // namespace rubble::explore
