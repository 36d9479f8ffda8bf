#include "explore/stuck/stuck_watch.h"

#include <gtest/gtest.h>

#include <optional>

#include "base/angle.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPose2D;

/// A robot on which a test can let come what may, tick by tick.
struct Watched {
  static constexpr double kTickTime = 0.02;  // [s]

  StuckWatch watch{TiltWatchConfig{}};
  Stamp now = Stamp::from_seconds(1.0);
  robot::Drive drive;    ///< what it is told
  bool obeys = true;     ///< moves as told
  bool stalls = false;   ///< the motors say so
  bool silent = false;   ///< no odometry arrives
  bool purpose = false;  ///< it may turn in its place
  double lean = 0.0;     ///< nose up [rad]
  double blow = 0.0;     ///< felt in every tick [m/s^2]
  TPose2D pose;

  std::optional<StuckWatch::Hold> tick(double passed = kTickTime) {
    now = now + passed;
    if (obeys) pose = pose + TPose2D{drive.v * kTickTime, 0.0, drive.w * kTickTime};
    robot::Inputs inputs;
    inputs.now = now;
    if (!silent) inputs.odometry.push_back({now, pose, drive.v, drive.w, stalls});
    inputs.aims.push_back({now, -lean, 0.0});
    inputs.accelerations.push_back({now, blow, 0.0});
    watch.update(inputs, passed, kTickTime);
    return watch.held(pose, drive, purpose, kTickTime, now);
  }
  /// What is found within `seconds`, if anything is.
  std::optional<StuckWatch::Hold> within(double seconds) {
    for (double t = 0.0; t < seconds; t += kTickTime)
      if (const auto hold = tick()) return hold;
    return std::nullopt;
  }
};

TEST(StuckWatch, ARobotThatMovesAsToldIsNotHeld) {
  Watched robot;
  for (const robot::Drive& drive : {robot::Drive{0.4, 0.0}, robot::Drive{0.0, 1.0}, robot::Drive{-0.2, 0.3}}) {
    robot.drive = drive;
    EXPECT_FALSE(robot.within(10.0));
  }
}

TEST(StuckWatch, SaysHowItWasMet) {
  const auto met = [](const robot::Drive& drive) {
    Watched robot;
    robot.drive = drive;
    robot.obeys = false;
    const auto hold = robot.within(5.0);
    EXPECT_TRUE(hold) << drive.v << ' ' << drive.w;
    EXPECT_EQ(hold ? hold->how : "", "it does not move");
    return hold ? hold->met : Escape::Met::Forwards;
  };
  EXPECT_EQ(met({0.4, 0.0}), Escape::Met::Forwards);
  EXPECT_EQ(met({0.4, 0.5}), Escape::Met::Forwards);
  EXPECT_EQ(met({-0.2, 0.0}), Escape::Met::Backwards);
  EXPECT_EQ(met({0.0, 1.0}), Escape::Met::Turning);
  EXPECT_EQ(met({0.1, -1.0}), Escape::Met::Turning) << "as slow as turns on the spot are kept on it";
}

/// The wheels are dragged aside then, and stick and slip.
TEST(StuckWatch, WhatJoltsARobotThatTurnsOnTheSpotIsNoBlow) {
  const auto blow_at = [](const robot::Drive& drive, bool braked) {
    Watched robot;
    robot.drive = drive;
    EXPECT_FALSE(robot.within(1.0));
    robot.blow = -8.0;
    if (braked) robot.watch.braked(robot.now);
    return robot.within(0.2).has_value();
  };
  EXPECT_FALSE(blow_at({0.12, 0.5}, false));
  EXPECT_TRUE(blow_at({0.3, 0.5}, false));
  EXPECT_TRUE(blow_at({0.12, 0.0}, false)) << "straight on it is one";
  EXPECT_FALSE(blow_at({0.3, 0.5}, true)) << "its own brake";
}

/// Half of the speed is lost at the edge of a ramp as well as where a corner meets a step.
TEST(StuckWatch, AWeakBlowCountsWhereTheRobotFallsBehindItsWheels) {
  for (const bool goes_on : {true, false}) {
    Watched robot;
    robot.drive = {0.3, 0.0};
    EXPECT_FALSE(robot.within(1.0));
    robot.blow = -0.55 * robot.drive.v / Watched::kTickTime;
    EXPECT_FALSE(robot.tick());
    robot.blow = 0.0;
    robot.obeys = goes_on;
    const auto hold = robot.within(0.4);
    EXPECT_EQ(hold.has_value(), !goes_on);
    if (!hold) continue;
    EXPECT_EQ(hold->how, "a blow holds it back");
    EXPECT_FALSE(hold->stands) << "it knows why";
  }
}

TEST(StuckWatch, TellsLeaningBlowsAndStallsApart) {
  Watched leaning, struck, stalling;
  leaning.lean = deg_to_rad(25.0);
  const auto leans = leaning.within(2.0);
  ASSERT_TRUE(leans);
  EXPECT_EQ(leans->how, "it leans too much here");

  struck.drive = {-0.3, 0.0};
  ASSERT_FALSE(struck.within(1.0));
  struck.blow = 8.0;  // it drives backwards
  const auto blow = struck.within(0.2);
  ASSERT_TRUE(blow);
  EXPECT_EQ(blow->how, "a blow stops it");
  EXPECT_EQ(blow->met, Escape::Met::Backwards);

  stalling.drive = {0.3, 0.0};
  stalling.stalls = true;
  const auto stall = stalling.within(1.0);
  ASSERT_TRUE(stall);
  EXPECT_EQ(stall->how, "the motors stall");
}

TEST(StuckWatch, AHoldIsToldOnce) {
  Watched robot;
  robot.drive = {0.4, 0.0};
  robot.obeys = false;
  ASSERT_TRUE(robot.within(5.0));
  EXPECT_FALSE(robot.tick());
  EXPECT_TRUE(robot.within(5.0)) << "but found anew while it lasts";
}

/// A pose that falls behind a robot that moves is no sign for a while; what else tells is one all the same.
TEST(StuckWatch, WherePosesAreDoubtedOtherSignsCount) {
  Watched robot;
  robot.drive = {0.4, 0.0};
  ASSERT_FALSE(robot.within(1.0));
  robot.obeys = false;
  const auto hold = robot.within(2.0);
  ASSERT_TRUE(hold);
  EXPECT_TRUE(robot.watch.brake_can_tell(*hold, robot.now));
  robot.watch.doubt_pose(robot.now);
  EXPECT_FALSE(robot.within(1.9));
  EXPECT_TRUE(robot.within(1.0)) << "not for ever";

  robot.watch.doubt_pose(robot.now);
  robot.stalls = true;
  const auto stall = robot.within(1.0);
  ASSERT_TRUE(stall);
  EXPECT_FALSE(robot.watch.brake_can_tell(*stall, robot.now)) << "there is no doubt";

  robot.stalls = false;
  robot.drive = {0.0, 1.0};
  robot.watch.doubt_pose(robot.now);
  const auto turn = robot.within(1.9);
  ASSERT_TRUE(turn) << "the heading does not fall behind";
  EXPECT_FALSE(robot.watch.brake_can_tell(*turn, robot.now));
}

/// Its pose goes on, so no brake could tell more; that its heading stays is a sign of its own.
TEST(StuckWatch, SteeringInVainIsToldApartFromStanding) {
  for (const bool turns : {false, true}) {
    Watched robot;
    robot.drive = {0.3, -0.6};
    robot.obeys = turns;
    std::optional<StuckWatch::Hold> hold;
    for (int i = 0; i < 200 && !hold; ++i) {
      if (!turns) robot.pose.x += 0.8 * robot.drive.v * Watched::kTickTime;
      hold = robot.tick();
    }
    ASSERT_EQ(hold.has_value(), !turns);
    if (!hold) continue;
    EXPECT_TRUE(hold->steers_in_vain);
    EXPECT_FALSE(hold->stands);
    EXPECT_FALSE(robot.watch.brake_can_tell(*hold, robot.now));
  }
}

TEST(StuckWatch, BrakingTellsWhetherTheRobotMoved) {
  for (const bool moves : {true, false}) {
    Watched robot;
    robot.drive = {0.4, 0.0};
    ASSERT_FALSE(robot.within(1.0));
    robot.watch.begin_brake_test(robot.now);
    EXPECT_EQ(robot.watch.brake_verdict(robot.now), BrakeTest::Verdict::Open);
    robot.drive = {};
    robot.blow = moves ? -0.4 / (2.0 * Watched::kTickTime) : 0.0;
    EXPECT_FALSE(robot.within(2.0 * Watched::kTickTime)) << "its own brake is no blow";
    robot.blow = 0.0;
    EXPECT_FALSE(robot.within(0.3));
    EXPECT_EQ(robot.watch.brake_verdict(robot.now), moves ? BrakeTest::Verdict::Moved : BrakeTest::Verdict::Stood);
  }
}

TEST(StuckWatch, NobodyKnowsWhetherASilentBaseMoves) {
  Watched robot;
  robot.drive = {0.4, 0.0};
  robot.tick();
  robot.silent = true;
  robot.obeys = false;
  EXPECT_FALSE(robot.within(5.0));
  robot.silent = false;
  EXPECT_TRUE(robot.within(5.0));
}

/// A device was away: the robot was held meanwhile, and its motors come back later than the device.
TEST(StuckWatch, AfterALongTickItIsPatient) {
  Watched robot;
  robot.drive = {0.4, 0.0};
  robot.tick();
  robot.obeys = false;
  robot.tick(3.0);
  EXPECT_FALSE(robot.within(1.9));
  EXPECT_TRUE(robot.within(3.0));
}

TEST(StuckWatch, TurningToAndFroOnPurposeIsNoRocking) {
  for (const bool purpose : {true, false}) {
    Watched robot;
    robot.purpose = purpose;
    bool held = false;
    for (int turn = 0; turn < 20 && !held; ++turn) {
      robot.drive = {0.0, turn % 2 == 0 ? 1.0 : -1.0};
      held = robot.within(1.0).has_value();
    }
    EXPECT_EQ(held, !purpose);
  }
}

}  // namespace
}  // namespace rubble::explore
