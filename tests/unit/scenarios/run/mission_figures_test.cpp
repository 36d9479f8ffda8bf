// What the truth says about a mission: where the floor ends, what could have been seen, how it ended.
#include "scenarios/run/mission_figures.h"

#include <gtest/gtest.h>

#include "base/rng.h"
#include "tests/support/base_files.h"
#include "tests/support/sim_arena.h"

namespace rubble::scenarios {
namespace {

using mrpt::math::TPose2D;

arenas::Victim victim(double x, double y, double facing) {
  arenas::Victim out;
  out.position = {x, y, 0.3};
  out.facing = facing;
  return out;
}

/// A closed room of 6 x 4 m around the start, which is at the origin.
arenas::Arena room() { return sim::test::room(-1.0, -2.0, 5.0, 2.0); }

TEST(OffTheFloor, IsWhereNoPatchLies) {
  arenas::Arena arena = sim::test::flat_floor(-1.0, -1.0, 2.0, 1.0);
  arena.floor.push_back({sim::test::rectangle(3.0, -1.0, 4.0, 1.0), 0.4, 0.0, 0.0, "platform"});  // beyond a gap
  const arenas::PatchIndex floor(arena);
  Rng rng(7, "places");
  int off = 0;
  for (int i = 0; i < 2000; ++i) {
    const double x = rng.uniform(-2.0, 5.0);
    const double y = rng.uniform(-2.0, 2.0);
    const bool on = std::abs(y) < 1.0 && ((x > -1.0 && x < 2.0) || (x > 3.0 && x < 4.0));
    off += on ? 0 : 1;
    EXPECT_EQ(off_the_floor(floor, TPose2D(x, y, rng.uniform(-3.0, 3.0))), !on) << "seed 7: " << x << ", " << y;
  }
  EXPECT_GT(off, 500);
  EXPECT_LT(off, 1800);
}

TEST(VisibleShare, OfAnOpenRoomIsAll) { EXPECT_EQ(visible_share(room(), {}), 1.0); }

/// The laser sees 4 m, but the robot may go anywhere: the length of the room does not matter.
TEST(VisibleShare, OfARoomLongerThanTheLaserSeesIsAll) {
  EXPECT_EQ(visible_share(sim::test::room(-1.0, -1.0, 14.0, 1.0), {}), 1.0);
}

/// The truth map itself knows no floor in a closed pocket: nothing there could be seen, nothing is asked for.
TEST(VisibleShare, WhatLiesBehindAWallWithoutADoorDoesNotCount) {
  arenas::Arena closed = room();
  sim::test::add_wall(closed, 2.0, -2.0, 2.02, 2.0);
  EXPECT_EQ(visible_share(closed, {}), 1.0);
  arenas::Arena open = room();
  sim::test::add_wall(open, 2.0, -2.0, 2.02, 1.0);  // a door of 1 m
  EXPECT_EQ(visible_share(open, {}), 1.0);
}

/// The robot is 0.5 m wide: through narrower gaps it only looks, the wider the more.
TEST(VisibleShare, GrowsWithAGapTooNarrowToPass) {
  double last = 0.5;  // the near half of the room
  for (const double gap : {0.2, 0.3, 0.4}) {
    arenas::Arena arena = room();
    sim::test::add_wall(arena, 2.0, -2.0, 2.02, 2.0 - gap);
    const double share = visible_share(arena, {});
    EXPECT_GT(share, last) << gap;
    EXPECT_LT(share, 0.95) << gap;
    last = share;
  }
}

TEST(VisibleShare, OfAnArenaWithoutFloorIsNone) { EXPECT_EQ(visible_share(arenas::Arena(), {}), 0.0); }

std::size_t visible_victims(const arenas::Arena& arena, const robot::RobotModel& model) {
  return arena.victims.size() - unseen_victims(arena, model).size();
}

TEST(VisibleVictims, AreThoseThatOpenToWhereTheRobotGets) {
  arenas::Arena arena = room();
  EXPECT_EQ(visible_victims(arena, {}), 0u);
  arena.victims = {victim(4.9, 0.0, kPi)};  // in the far wall, open to the room
  EXPECT_EQ(visible_victims(arena, {}), 1u);
  arena.victims = {victim(4.9, 0.0, 0.0)};  // open to the wall: nobody gets between
  EXPECT_EQ(visible_victims(arena, {}), 0u);
  arena.victims = {victim(4.9, 0.0, kPi), victim(4.9, 1.0, kPi), victim(4.9, -1.0, 0.0)};
  EXPECT_EQ(visible_victims(arena, {}), 2u);
}

TEST(VisibleVictims, BehindAWallAreNone) {
  arenas::Arena arena = room();
  arena.victims = {victim(4.9, 0.0, kPi)};
  sim::test::add_wall(arena, 2.0, -2.0, 2.02, 2.0);
  EXPECT_EQ(visible_victims(arena, {}), 0u);
}

TEST(UnseenVictims, AreNamedAndAreAllThatAreNotVisible) {
  arenas::Arena arena = room();
  arena.victims = {victim(4.9, 0.0, kPi), victim(4.9, 1.0, 0.0), victim(4.9, -1.0, kPi)};
  for (const auto& [i, name] : {std::pair{0, "anna"}, {1, "bert"}, {2, "carl"}})
    arena.victims[static_cast<std::size_t>(i)].name = name;
  EXPECT_EQ(unseen_victims(arena, {}), std::vector<std::string>{"bert"}) << "it opens to the wall";
  EXPECT_EQ(visible_victims(arena, {}), 2u);
  sim::test::add_wall(arena, 2.0, -2.0, 2.02, 2.0);
  EXPECT_EQ(unseen_victims(arena, {}), (std::vector<std::string>{"anna", "bert", "carl"}));
}

/// A box whose lid is open at the top alone: the plan shows a way in that no camera at 0.5 m has.
TEST(VisibleVictims, BehindAWallThatIsOpenAboveTheCamerasAreNone) {
  arenas::Arena arena = room();
  arena.victims = {victim(4.9, 0.0, kPi)};
  arena.victims.front().position.z = 0.3;
  sim::test::add_wall(arena, 4.5, -2.0, 4.52, 2.0, 0.2);
  EXPECT_EQ(visible_victims(arena, {}), 1u) << "over a sill of 0.2 m";
  sim::test::add_wall(arena, 4.5, -2.0, 4.52, 2.0, 0.8);
  EXPECT_EQ(visible_victims(arena, {}), 0u) << "over a sill of 0.8 m";
  arena.victims.front().position.z = 0.9;
  EXPECT_EQ(visible_victims(arena, {}), 1u) << "raised above the sill";
}

/// Cameras reach 2 m: a victim that stands farther behind a trench than that is out of their reach.
TEST(VisibleVictims, AcrossATrenchCountAsFarAsTheCamerasReach) {
  arenas::Arena arena = sim::test::flat_floor(-1.0, -1.0, 2.0, 1.0);
  arena.floor.push_back({sim::test::rectangle(3.0, -1.0, 8.0, 1.0), 0.0, 0.0, 0.0, "flat"});
  arena.max_corner = {8.0, 1.0};
  arena.victims = {victim(3.3, 0.0, kPi)};
  EXPECT_EQ(visible_victims(arena, {}), 1u);
  arena.victims = {victim(4.5, 0.0, kPi)};
  EXPECT_EQ(visible_victims(arena, {}), 0u);
}

TEST(TrueEnd, HomeIsWhereTheRobotStartedNotWhereItThinksThatWas) {
  EXPECT_EQ(true_end("home", 0.3), "home");
  EXPECT_EQ(true_end("home", 1.0), "home");
  EXPECT_EQ(true_end("home", 1.01), "lost");
  for (const char* other : {"explored", "stuck", "time"}) EXPECT_EQ(true_end(other, 5.0), other);
}

class MissionEnds : public ::testing::Test {
 protected:
  std::string end_code(const Trajectory& truth, bool explores) {
    const Core core(scenario_, scenario_.robot, explores, folder_.path());
    return mission_figures(room(), truth, scenario_.robot, core).end_code;
  }

  test::TempFolder folder_;
  Scenario scenario_;
};

TEST_F(MissionEnds, ARobotThatEndsBeyondTheRimFell) {
  const Trajectory stayed{{Stamp{0}, {}}, {Stamp::from_seconds(1.0), {0.5, 0.0, 0.0}}};
  Trajectory fell = stayed;
  fell.push_back({Stamp::from_seconds(2.0), {5.2, 0.0, 0.0}});
  for (const bool explores : {true, false}) {
    EXPECT_EQ(end_code(stayed, explores), "time");
    EXPECT_EQ(end_code(fell, explores), "fell");
    EXPECT_EQ(end_code({}, explores), "time");
  }
}

/// Only the end counts: a robot that stands on a floor has not fallen, wherever it was before.
TEST_F(MissionEnds, ARobotThatCameBackDidNotFall) {
  const Trajectory back{
      {Stamp{0}, {}}, {Stamp::from_seconds(1.0), {5.2, 0.0, 0.0}}, {Stamp::from_seconds(2.0), {4.0, 0.0, 0.0}}};
  EXPECT_EQ(end_code(back, true), "time");
}

}  // namespace
}  // namespace rubble::scenarios
