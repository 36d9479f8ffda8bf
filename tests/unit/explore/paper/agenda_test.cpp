#include "explore/paper/agenda.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/planar.h"
#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

PaperExplorerConfig without_search() {
  PaperExplorerConfig config;
  config.search.on = false;
  config.felt.pallet = 0.0;  // its rooms are not built of them
  return config;
}

/// A robot without a body: it is where its orders lead it, at once, and sees nothing but what a test draws.
struct Ordered {
  explicit Ordered(const PaperExplorerConfig& config = without_search())
      : agenda(config),
        left_alone(config.felt, config.planner.same_target),
        search(config.search, 0.46, 0.4),
        close_looks(config.felt.pallet, {0.145, 0.0}) {
    agenda.set_home({now, pose});
  }
  /// The room becomes a corridor along y = 0.65, with the robot in it.
  void narrow() {
    cells = test::room(8.0, 1.3);
    pose.y = 0.65;
  }
  Agenda::Situation situation() {
    floor = traversable(cells);
    close_looks.apply(floor);
    agenda.pushing().free_things(floor);
    measure_clearance(floor, 1.2);
    return {now, pose, floor, turning, 0, left_alone, search, 0.2, nullptr, &close_looks};
  }
  Order ask() {
    now = now + 5.0;
    map.stamp({}, {});
    const bool new_map = agenda.begin_plan(map, now);
    Plan plan = agenda.choose(situation());
    return agenda.decide(std::move(plan), new_map, situation());
  }
  bool told(const std::string& what) const {
    const auto& decisions = agenda.decisions();
    return std::any_of(decisions.begin(), decisions.end(),
                       [&](const Decision& d) { return d.why.find(what) != std::string::npos; });
  }

  Agenda agenda;
  LeftAlone left_alone;
  FloorSearch search;
  CloseLooks close_looks;
  OccupancyGrid cells = test::room(8.0, 4.0);
  Traversable floor;
  slam::CountMap map{10, 10, 0.05};
  TPose2D pose{2.0, 2.0, 0.0};
  Stamp now = Stamp::from_seconds(1.0);
  bool turning = false;
};

TEST(Agenda, ExploresThenLooksAroundThenGoesHomeAndEnds) {
  Ordered robot;
  test::fill(robot.cells, 6.0, 1.5, 7.0, 2.5, Occupancy::Unknown);
  Order order = robot.ask();
  ASSERT_EQ(order.kind, Order::Kind::Follow);
  EXPECT_TRUE(robot.told("drives to the frontier"));
  robot.pose = {order.plan.target.x, order.plan.target.y, 0.0};
  robot.cells = test::room(8.0, 4.0);  // it has seen it now
  EXPECT_EQ(robot.ask().kind, Order::Kind::Turn);
  order = robot.ask();
  for (int i = 0; i < 5 && order.kind != Order::Kind::Follow; ++i) order = robot.ask();
  ASSERT_EQ(order.kind, Order::Kind::Follow);
  EXPECT_EQ(robot.agenda.goal(), Goal::Home);
  EXPECT_FALSE(robot.agenda.finished());
  robot.pose = {order.plan.target.x, order.plan.target.y, 0.0};
  EXPECT_EQ(robot.ask().kind, Order::Kind::Stop);
  EXPECT_EQ(robot.agenda.end(), MissionEnd::Home);
  EXPECT_EQ(robot.agenda.reason(), "nothing reachable left to explore, home again");
}

TEST(Agenda, WithoutAReturnItEndsWhereNothingIsLeft) {
  PaperExplorerConfig config = without_search();
  config.return_home = false;
  Ordered robot(config);
  for (int i = 0; i < 10 && !robot.agenda.finished(); ++i) robot.ask();
  EXPECT_EQ(robot.agenda.end(), MissionEnd::Explored);
  EXPECT_EQ(robot.agenda.goal(), Goal::Frontier);
}

/// What stays although the robot stands there: one look around, then it is left alone for good.
TEST(Agenda, AFrontierThatStaysIsLeftAlone) {
  Ordered robot;
  test::fill(robot.cells, 2.0, 2.15, 2.4, 2.55, Occupancy::Unknown);
  EXPECT_EQ(robot.ask().kind, Order::Kind::Turn);
  robot.turning = true;
  EXPECT_EQ(robot.ask().kind, Order::Kind::Stay) << "it is looking around";
  robot.turning = false;
  EXPECT_EQ(robot.ask().kind, Order::Kind::Stay);
  EXPECT_TRUE(robot.told("stays although it was visited"));
  EXPECT_TRUE(robot.left_alone.barred({2.2, 2.1}, robot.now + 1e6));
}

/// A wall off the edges of the pallets: what is seen right before it tells whether it is one.
TEST(Agenda, AWallThatMayBeASlopeIsDrivenOverWhereTheNewestScansPassOverIt) {
  for (const bool slope : {true, false}) {
    PaperExplorerConfig config = without_search();
    config.felt.pallet = test::kPallet;
    Ordered robot(config);
    robot.cells = test::corridor_of_pallets(5.6, test::kPallet, Occupancy::Unknown);
    robot.pose = {2.0, 0.6, 0.0};
    Order order = robot.ask();
    for (int i = 0; i < 3 && order.kind != Order::Kind::Follow; ++i) order = robot.ask();
    ASSERT_EQ(order.kind, Order::Kind::Follow);
    ASSERT_TRUE(robot.agenda.doubted_wall());
    robot.pose = {order.plan.target.x, order.plan.target.y, 0.0};
    ASSERT_EQ(robot.ask().kind, Order::Kind::Turn);
    std::vector<TPoint2D> hits;
    for (double y = -2.0; y < 2.0; y += 0.01) hits.emplace_back(slope ? 8.0 : 5.6, 0.6 + y);
    for (int i = 0; i < 9; ++i) robot.close_looks.look(hits, robot.pose);
    robot.ask();
    EXPECT_EQ(robot.told("is the floor of a slope: seen over"), slope);
    EXPECT_EQ(robot.told("stays although it was visited"), !slope);
    EXPECT_EQ(robot.left_alone.barred(position(robot.pose), robot.now), !slope);
    order = robot.ask();
    EXPECT_EQ(order.kind == Order::Kind::Follow, slope) << "on, to the ground behind it";
    if (slope) {
      EXPECT_GT(order.plan.target.x, 5.4);
    }
  }
}

/// A ball lies in the door to what is not known yet.
TEST(Agenda, PushesSmallThingsWhenNothingElseHelps) {
  Ordered robot;
  test::fill(robot.cells, 4.0, 0.0, 4.1, 4.0, Occupancy::Occupied);
  test::fill(robot.cells, 6.0, 1.0, 7.0, 3.0, Occupancy::Unknown);
  for (int i = 0; i < 12 && !robot.agenda.pushing().on(); ++i) robot.ask();
  EXPECT_TRUE(robot.agenda.pushing().on());
  EXPECT_TRUE(robot.told("small things that stand alone may be pushed aside"));
  for (int i = 0; i < 40 && robot.agenda.goal() != Goal::Home; ++i) robot.ask();
  EXPECT_TRUE(robot.told("heaps that stand alone may be pushed aside"));
  EXPECT_TRUE(robot.told("1 frontier cannot be reached"));
}

/// The floor of a slope, taken for a wall, keeps it from a niche: it is driven at before all other faces are searched.
TEST(Agenda, PushesOnToANicheBeforeItSearchesAllElse) {
  Ordered robot((PaperExplorerConfig()));
  const double shut = 5.6, niche = 7.8;  // [m]
  robot.cells = test::corridor_of_pallets(shut, test::kPallet, Occupancy::Free);
  for (const double side : {-0.19, 0.19})
    test::fill(robot.cells, niche + side - 0.03, 0.0, niche + side + 0.03, 0.42, Occupancy::Occupied);
  robot.pose = {2.0, 0.6, 0.0};
  const auto drives_to = [&](const Order& order) {
    return order.kind == Order::Kind::Follow ? order.plan.target.x : 0.0;
  };
  Order order;
  for (int i = 0; i < 60 && order.kind != Order::Kind::Follow; ++i) order = robot.ask();
  EXPECT_GT(drives_to(order), shut);
  EXPECT_TRUE(robot.told("a niche is out of reach: what stands off the pallets' edges may be pushed aside"));
  // Where it stays out of reach for all that, the rest is searched.
  test::fill(robot.cells, 4 * test::kPallet - 0.03, 0.0, 4 * test::kPallet + 0.03, test::kPallet, Occupancy::Occupied);
  order = {};
  for (int i = 0; i < 60 && order.kind != Order::Kind::Follow; ++i) order = robot.ask();
  EXPECT_LT(drives_to(order), shut);
  EXPECT_FALSE(robot.agenda.pushing().on());
}

/// On the way to a niche the floor of a slope is drawn across its way: once it drives on all the same, for from farther
/// off the way would be free again, and the robot drive to and fro between this niche and one far away.
TEST(Agenda, InsistsOnceOnAPlaceWhoseWayIsShutOffTheGrid) {
  Ordered robot((PaperExplorerConfig()));
  robot.cells = test::corridor_of_pallets(7.8, 0.0, Occupancy::Free);
  for (const double niche : {0.5, 9.1})
    for (const double side : {-0.19, 0.19})
      test::fill(robot.cells, niche + side - 0.03, 0.0, niche + side + 0.03, 0.42, Occupancy::Occupied);
  robot.pose = {7.0, 0.6, 0.0};
  const auto next_way = [&] {
    Order order;
    for (int i = 0; i < 60 && order.kind != Order::Kind::Follow; ++i) order = robot.ask();
    return order.kind == Order::Kind::Follow ? order.plan.target.x : 0.0;
  };
  EXPECT_GT(next_way(), 7.8);
  const OccupancyGrid before = robot.cells;
  test::fill(robot.cells, 7.77, 0.0, 7.83, test::kPallet, Occupancy::Occupied);
  EXPECT_GT(next_way(), 7.8);
  EXPECT_TRUE(robot.agenda.pushing().on());
  // It is a wall: a wall on an edge is shut, too.
  test::fill(robot.cells, 7 * test::kPallet - 0.03, 0.0, 7 * test::kPallet + 0.03, test::kPallet, Occupancy::Occupied);
  EXPECT_LT(next_way(), 7.8);
  EXPECT_FALSE(robot.agenda.pushing().on());
  robot.cells = before;
  EXPECT_GT(next_way(), 7.8);
  test::fill(robot.cells, 7.77, 0.0, 7.83, test::kPallet, Occupancy::Occupied);
  EXPECT_LT(next_way(), 7.8) << "once";
}

TEST(Agenda, OnTheWayHomeThingsAreDrivenRoundAgain) {
  Ordered robot;
  test::fill(robot.cells, 4.0, 0.0, 4.1, 4.0, Occupancy::Occupied);
  test::fill(robot.cells, 6.0, 1.0, 7.0, 3.0, Occupancy::Unknown);
  for (int i = 0; i < 12 && !robot.agenda.pushing().on(); ++i) robot.ask();
  ASSERT_TRUE(robot.agenda.pushing().on());
  robot.agenda.go_home("", robot.now);
  EXPECT_FALSE(robot.agenda.pushing().on());
}

/// What lies ahead of a viewpoint is dwelt on; what does not is faced first. `sees`: the sensors look on the way.
TEST(Agenda, FacesAPlaceToSearchOrDwellsBeforeIt) {
  for (const bool sees : {false, true}) {
    Ordered robot((PaperExplorerConfig()));
    bool faced = false, dwelt = false;
    for (int i = 0; i < 60 && !(sees ? faced : dwelt); ++i) {
      const Order order = robot.ask();
      if (order.kind == Order::Kind::Follow) robot.pose = {order.plan.target.x, order.plan.target.y, robot.pose.phi};
      if (order.kind == Order::Kind::Turn) robot.pose.phi = wrap_angle(robot.pose.phi + order.angle);
      faced = faced || (order.kind == Order::Kind::Turn && order.purpose == TurnFor::Place);
      dwelt = dwelt || robot.search.dwelling(robot.floor, robot.pose, robot.now);
      for (int looks = 0; sees && looks < 3; ++looks)
        robot.search.look(robot.floor, robot.pose, 0.0, robot.now = robot.now + 1.0);
    }
    EXPECT_EQ(robot.agenda.goal(), Goal::Place);
    EXPECT_TRUE(sees ? faced : dwelt) << "sees: " << sees;
  }
}

TEST(Agenda, ATargetThatCostsMoreTimeThanItDeservesIsLeftAlone) {
  Ordered robot;
  test::fill(robot.cells, 6.0, 1.5, 7.0, 2.5, Occupancy::Unknown);
  const Order order = robot.ask();
  ASSERT_EQ(order.kind, Order::Kind::Follow);
  double spent = 0.0;
  for (; robot.agenda.target() && spent < 1000.0; spent += 1.0) robot.agenda.spend(1.0, robot.situation());
  EXPECT_GT(spent, order.plan.cost / 0.4) << "more than the drive takes";
  EXPECT_LT(spent, 1000.0);
  EXPECT_TRUE(robot.left_alone.barred(order.plan.target, robot.now));
  EXPECT_TRUE(robot.agenda.due(robot.map, robot.now));
}

/// A place to search that fails waits for the next round; after a minute it would call the robot back from the other
/// end.
TEST(Agenda, APlaceThatCostsMoreTimeThanItDeservesIsLeftAloneUntilAllIsPardoned) {
  Ordered robot((PaperExplorerConfig()));
  robot.situation();
  for (int i = 0; i < 100; ++i)  // what is around it was looked at
    robot.search.look(robot.floor, {2.0, 2.0, 0.13 * i}, 0.0, robot.now = robot.now + 1.0);
  for (int i = 0; i < 60 && !(robot.agenda.goal() == Goal::Place && robot.agenda.target()); ++i) {
    const Order order = robot.ask();
    if (order.kind == Order::Kind::Turn) robot.pose.phi = wrap_angle(robot.pose.phi + order.angle);
  }
  ASSERT_EQ(robot.agenda.goal(), Goal::Place);
  ASSERT_TRUE(robot.agenda.target());
  const TPoint2D place = *robot.agenda.target();
  for (double spent = 0.0; robot.agenda.target() && spent < 1000.0; spent += 1.0)
    robot.agenda.spend(1.0, robot.situation());
  EXPECT_TRUE(robot.left_alone.barred(place, robot.now + 1e6));
  EXPECT_TRUE(robot.left_alone.pardon_all(robot.now));
  EXPECT_FALSE(robot.left_alone.barred(place, robot.now));
}

TEST(Agenda, ATargetThatSomethingNewKeepsItFromIsBarredAndNoOther) {
  for (const bool across : {true, false}) {
    Ordered robot;
    robot.narrow();
    test::fill(robot.cells, 6.5, 0.4, 7.0, 0.9, Occupancy::Unknown);
    test::fill(robot.cells, 0.3, 0.4, 0.7, 0.9, Occupancy::Unknown);
    robot.pose.x = 4.0;
    const Order order = robot.ask();
    ASSERT_EQ(order.kind, Order::Kind::Follow);
    ASSERT_GT(order.plan.target.x, 5.0);
    if (across) test::fill(robot.cells, 5.0, 0.0, 5.1, 1.3, Occupancy::Occupied);
    Plan other;
    other.found = true;
    other.target = {1.0, 0.65};
    robot.agenda.turn_away(other, 2.0, robot.situation());
    EXPECT_EQ(robot.left_alone.barred(order.plan.target, robot.now), across);
    EXPECT_EQ(robot.told("something new stands in the way"), across);
  }
}

/// Else it goes to and fro between two targets with something new before each, for as long as it takes to forget it.
TEST(Agenda, ATargetThatNewThingsTurnItAwayFromRightBeforeItOrTwiceIsLeftAlone) {
  for (const double left : {2.0, 0.8}) {
    Ordered robot;
    robot.narrow();
    test::fill(robot.cells, 6.5, 0.4, 7.0, 0.9, Occupancy::Unknown);
    robot.pose.x = 6.4 - left;
    const Order order = robot.ask();
    ASSERT_EQ(order.kind, Order::Kind::Follow);
    robot.agenda.spend(0.1, robot.situation());
    test::fill(robot.cells, 6.2, 1.1, 6.3, 1.3, Occupancy::Occupied);  // a way to near it is left
    Plan other;
    other.found = true;
    other.target = {1.0, 0.65};
    robot.agenda.turn_away(other, left, robot.situation());
    EXPECT_EQ(robot.left_alone.barred(order.plan.target, robot.now), left < 1.0);
    if (left < 1.0) continue;
    robot.agenda.turn_away(other, left, robot.situation());
    EXPECT_TRUE(robot.left_alone.barred(order.plan.target, robot.now)) << "the second time";
  }
}

/// Another round in a room whose frontiers are behind a hole in the wall, in a pocket, and visited in vain.
TEST(Agenda, WhatCannotBeHadIsNotTriedAgainBeforeTheFacesAreSearched) {
  for (const bool more : {false, true}) {
    Ordered robot((PaperExplorerConfig()));
    test::fill(robot.cells, 6.0, 0.0, 6.1, 4.0, Occupancy::Occupied);
    test::fill(robot.cells, 6.0, 1.9, 6.1, more ? 2.6 : 2.05, Occupancy::Free);
    test::fill(robot.cells, 6.5, 1.5, 7.5, 2.5, Occupancy::Unknown);
    if (more) robot.left_alone.bar({6.3, 2.0}, {robot.now, robot.pose}, 100.0);
    for (int i = 0; i < 60 && robot.agenda.goal() != Goal::Place; ++i) {
      const Order order = robot.ask();
      if (order.kind == Order::Kind::Follow) break;
    }
    EXPECT_EQ(robot.told("what failed before is tried again") || robot.told("drives to the frontier"), more);
    EXPECT_FALSE(!more && robot.told("pushed aside"));
  }
}

/// What the robot does else meanwhile, such as to get free or to look into niches, tells nothing about frontiers.
TEST(Agenda, TheFacesGoFirstAfterMuchTimeSpentOnFrontiersInVain) {
  for (const double spent : {200.0, 250.0}) {
    Ordered robot((PaperExplorerConfig()));
    robot.narrow();
    test::fill(robot.cells, 6.4, 0.3, 7.6, 1.0, Occupancy::Unknown);
    ASSERT_EQ(robot.ask().kind, Order::Kind::Follow);
    ASSERT_EQ(robot.agenda.goal(), Goal::Frontier);
    robot.now = robot.now + 250.0;
    for (const double s : {1.0, spent - 1.0}) robot.agenda.spend(s, robot.situation());
    ASSERT_FALSE(robot.agenda.target()) << "it is barred";
    for (int i = 0; i < 60 && robot.agenda.goal() != Goal::Place; ++i)
      if (robot.ask().kind == Order::Kind::Follow) break;
    EXPECT_EQ(robot.told("what failed before is tried again"), spent < 240.0);
  }
}

/// Where walls have holes all faces have to be looked at squarely, which takes more time than there is.
TEST(Agenda, WhereWallsHaveHolesTheFacesGoBeforeAllSecondTries) {
  for (const bool holes : {false, true}) {
    Ordered robot((PaperExplorerConfig()));
    robot.narrow();
    test::fill(robot.cells, 6.4, 0.3, 7.6, 1.0, Occupancy::Unknown);
    if (holes) robot.search.expect_holes();
    robot.left_alone.bar({6.4, 0.65}, {robot.now, robot.pose}, 100.0);
    for (int i = 0; i < 60 && robot.agenda.goal() != Goal::Place; ++i)
      if (robot.ask().kind == Order::Kind::Follow) break;
    EXPECT_EQ(robot.told("is tried again"), !holes);
    EXPECT_EQ(robot.agenda.goal() == Goal::Place, holes);
  }
}

/// The other way to the same target is taken to its end: the robot would turn back else once it has forgotten what
/// stands in the shorter one.
TEST(Agenda, TheSameTargetByADetourIsLedRoundWhatIsNew) {
  Ordered robot;
  test::fill(robot.cells, 6.0, 1.5, 7.0, 2.5, Occupancy::Unknown);
  const Order order = robot.ask();
  ASSERT_EQ(order.kind, Order::Kind::Follow);
  const double way = length_of(order.plan);
  EXPECT_TRUE(robot.agenda.turn_away(order.plan, way - 2.1, robot.situation()));
  EXPECT_FALSE(robot.agenda.turn_away(order.plan, way - 1.9, robot.situation()));
  EXPECT_FALSE(robot.agenda.turn_away({}, 0.0, robot.situation())) << "there is no way";
  EXPECT_FALSE(robot.left_alone.barred(order.plan.target, robot.now));
}

TEST(Agenda, WithoutAKnownWayHomeItTakesADetourButNotMoreThanItCame) {
  Ordered robot;
  robot.narrow();
  robot.agenda.set_home({robot.now, robot.pose});
  robot.pose.x = 6.0;
  EXPECT_NEAR(robot.agenda.way_home(robot.situation(), 100.0), 4.0, 0.2);
  test::fill(robot.cells, 4.0, 0.0, 4.1, 1.3, Occupancy::Occupied);
  EXPECT_NEAR(robot.agenda.way_home(robot.situation(), 100.0), 12.0, 1e-9);
  EXPECT_EQ(robot.agenda.way_home(robot.situation(), 7.0), 7.0);
}

/// Floor that it has not driven on may stop it, when no time is left for another way.
TEST(Agenda, WhereSomethingWasFeltItGoesHomeOnFloorThatHasCarriedIt) {
  for (const double thick : {0.2, 2.0}) {  // the block between two lanes, the nearer of which it has not driven on
    Ordered robot;
    robot.cells = test::room(8.0, 2.4 + thick);
    test::fill(robot.cells, 1.2, 1.2, 6.8, 1.2 + thick, Occupancy::Occupied);
    robot.pose = {0.6, 0.6, 0.0};
    robot.agenda.set_home({robot.now, robot.pose});
    Trail trail;
    for (const TPoint2D& corner : {TPoint2D(0.6, 1.8 + thick), TPoint2D(7.4, 1.8 + thick), TPoint2D(7.4, 0.6)}) {
      const TPoint2D from = position(robot.pose);
      for (int i = 0; i <= 60; ++i) {
        robot.pose.x = from.x + (corner.x - from.x) * i / 60.0;
        robot.pose.y = from.y + (corner.y - from.y) * i / 60.0;
        trail.add(robot.now, robot.pose);
      }
    }
    Agenda::Situation situation = robot.situation();
    const double near = robot.agenda.way_home(situation, 100.0);
    EXPECT_NEAR(near, 6.8, 0.3);
    situation.trail = &trail;
    EXPECT_NEAR(robot.agenda.way_home(situation, 100.0), 6.8 + 2.0 * (1.2 + thick), 0.9);
    test::fill(robot.cells, 4.0, 1.2 + thick, 4.1, 2.4 + thick, Occupancy::Occupied);
    Agenda::Situation blocked = robot.situation();
    blocked.trail = &trail;
    EXPECT_NEAR(robot.agenda.way_home(blocked, 100.0), near, 0.3) << "its trail is blocked";
  }
}

TEST(Agenda, TheSameDecisionIsToldOnce) {
  Ordered robot;
  robot.agenda.note(robot.now, "a");
  robot.agenda.note(robot.now, "a");
  robot.agenda.note(robot.now, "b");
  robot.agenda.note(robot.now, "a");
  EXPECT_EQ(robot.agenda.decisions().size(), 3u);
}

}  // namespace
}  // namespace rubble::explore
