#include "robot/levelling_watch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angle.h"
#include "robot/hardware_units.h"
#include "robot/levelling.h"

namespace rubble::robot {
namespace {

constexpr double kTick = 0.02;  // [s]

/// A standing robot with a levelled platform.
struct Unit {
  explicit Unit(const RobotModel& robot = {}) : model(robot) {}

  RobotModel model;
  Levelling levelling{{}, model};
  LevellingWatch watch{model};
  double body = 0.0;   ///< pitch [rad]
  double servo = 0.0;  ///< where it stands [rad]
  bool turns = true;
  bool has_aims = true, has_accelerometer = true;
  Stamp now;

  void run(double seconds) {
    for (double t = 0.0; t < seconds; t += kTick) {
      Inputs inputs;
      inputs.now = now = now + kTick;
      if (has_accelerometer) inputs.accelerations.push_back({now, kGravity * std::sin(body + servo), 0.0});
      if (has_aims) inputs.aims.push_back({now, told_.pitch, told_.roll});
      watch.update(inputs);
      told_ = levelling.update(inputs);
      if (turns) servo = told_.pitch;
    }
  }

 private:
  LaserAim told_;
};

TEST(LevellingWatch, AUnitThatLevelsWorksOnAnyRamp) {
  Unit unit;
  for (const double deg : {0.0, 15.0, -15.0, 25.0, -25.0, 3.0}) {
    unit.body = deg_to_rad(deg);
    unit.run(3.0);
    EXPECT_EQ(unit.watch.state(), LevellingState::Works) << deg;
  }
}

/// From one ramp of 16 deg over its crest and down the next the body swings by 32 deg and the platform lags behind.
TEST(LevellingWatch, ASlowSwingFromRampToRampIsNoJam) {
  Unit unit;
  unit.body = deg_to_rad(16.0);
  unit.run(3.0);
  for (double deg = 16.0; deg > -16.0; deg -= 0.5) {  // 25 deg/s
    unit.body = deg_to_rad(deg);
    unit.run(kTick);
    ASSERT_EQ(unit.watch.state(), LevellingState::Works) << deg;
  }
  for (double lag = 6.0; lag > 2.5; lag -= 0.05) {  // and the servo closes in slowly
    unit.turns = false;
    unit.servo = deg_to_rad(16.0 - lag);
    unit.run(kTick);
    ASSERT_EQ(unit.watch.state(), LevellingState::Works) << lag;
  }
}

/// With its nose up a ramp of 45 deg the robot leans more than the servos can turn, and backs off.
TEST(LevellingWatch, ALeanBeyondTheServosTravelIsNoJam) {
  Unit unit;
  unit.run(1.0);
  for (const double deg : {40.0, -40.0}) {
    unit.body = deg_to_rad(deg);
    unit.run(2.0);
    EXPECT_EQ(unit.watch.state(), LevellingState::Works) << deg;
    unit.body = 0.0;
    unit.run(2.0);
    EXPECT_EQ(unit.watch.state(), LevellingState::Works) << "level again after " << deg;
  }
}

/// As onto a step that it climbs: soon far over, then on and on.
TEST(LevellingWatch, ARobotThatClimbsOnAndOnIsFollowedNotGivenUp) {
  for (const double sign : {1.0, -1.0})
    for (const double deg_per_s : {12.0, 13.0, 15.0}) {
      Unit unit;
      unit.run(1.0);
      while (std::abs(unit.body) < deg_to_rad(33.0)) {
        const double rate = std::abs(unit.body) < deg_to_rad(16.0) ? 20.0 : deg_per_s;
        unit.body += sign * deg_to_rad(rate) * kTick;
        unit.run(kTick);
        EXPECT_EQ(unit.watch.state(), LevellingState::Works) << deg_per_s << " " << rad_to_deg(unit.body);
      }
    }
}

TEST(LevellingWatch, ServosOfShortTravelAreSeenToBeJammedToo) {
  Unit unit;
  LevellingConfig config;
  config.max_angle = deg_to_rad(18.0);
  unit.levelling = Levelling{config, unit.model};
  unit.turns = false;
  unit.body = deg_to_rad(8.0);
  unit.run(5.0);
  EXPECT_EQ(unit.watch.state(), LevellingState::Jammed);
}

TEST(LevellingWatch, AfterASecondWithoutAWordItIsSilentUntilItTalksAgain) {
  Unit unit;
  unit.run(1.0);
  unit.has_aims = unit.has_accelerometer = false;
  unit.run(0.9);
  EXPECT_EQ(unit.watch.state(), LevellingState::Works);
  unit.run(0.2);
  EXPECT_EQ(unit.watch.state(), LevellingState::Silent);
  unit.has_aims = true;
  unit.run(0.5);
  EXPECT_EQ(unit.watch.state(), LevellingState::Silent) << "its accelerometer says nothing";
  unit.has_accelerometer = true;
  unit.run(0.1);
  EXPECT_EQ(unit.watch.state(), LevellingState::Works);
}

TEST(LevellingWatch, WhereThereNeverWereServosNothingIsMissed) {
  Unit unit;
  unit.has_aims = false;
  unit.run(1.0);
  unit.has_accelerometer = false;
  unit.run(10.0);
  EXPECT_EQ(unit.watch.state(), LevellingState::Works);
}

TEST(LevellingWatch, ServosThatTakeNoTiltAwayAreJammedWhereTheyWereLevelLast) {
  Unit unit;
  unit.body = deg_to_rad(8.0);
  unit.run(3.0);
  unit.turns = false;
  unit.run(5.0);
  EXPECT_EQ(unit.watch.state(), LevellingState::Works) << "nobody can know yet";
  unit.body = 0.0;
  unit.run(3.0);
  ASSERT_EQ(unit.watch.state(), LevellingState::Jammed);
  ASSERT_TRUE(unit.watch.jammed_at());
  // They were told a little more until the tilt was felt.
  EXPECT_NEAR(unit.watch.jammed_at()->pitch, deg_to_rad(-8.0), deg_to_rad(2.5));
  EXPECT_NEAR(unit.watch.jammed_at()->roll, 0.0, deg_to_rad(0.5));
  unit.body = deg_to_rad(8.0);
  unit.run(5.0);
  EXPECT_EQ(unit.watch.state(), LevellingState::Jammed) << "for good";
}

/// Jammed level, it aims as far as it can on a ramp that the robot backs off from at once, and nothing calls that back.
TEST(LevellingWatch, LevelAtAnAimAtWhichNoRobotLeansForLongItIsJammed) {
  for (const double sign : {1.0, -1.0}) {
    Unit unit;
    unit.run(3.0);
    unit.turns = false;
    unit.body = sign * deg_to_rad(12.0);
    unit.run(1.2);
    unit.body = 0.0;
    unit.run(5.0);
    EXPECT_EQ(unit.watch.state(), LevellingState::Works) << "a robot may hang somewhere";
    unit.run(4.0);
    ASSERT_EQ(unit.watch.state(), LevellingState::Jammed);
    EXPECT_NEAR(unit.watch.jammed_at()->pitch, 0.0, deg_to_rad(1.5));
  }
}

TEST(LevellingWatch, ARobotThatHangsForSomeSecondsIsFollowed) {
  Unit unit;
  unit.run(3.0);
  unit.body = deg_to_rad(28.0);
  unit.run(7.0);
  EXPECT_EQ(unit.watch.state(), LevellingState::Works);
  unit.body = 0.0;
  unit.run(20.0);
  EXPECT_EQ(unit.watch.state(), LevellingState::Works);
}

/// A robot that brakes again and again feels its tilted platform swing through level.
TEST(LevellingWatch, WhatBrakingMakesLookLevelForAMomentIsNotLevel) {
  Unit unit;
  unit.run(3.0);
  unit.turns = false;
  for (int i = 0; i < 10; ++i) {
    unit.body = deg_to_rad(6.0);
    unit.run(0.7);
    unit.body = 0.0;
    unit.run(0.3);
  }
  unit.body = deg_to_rad(6.0);
  unit.run(3.0);
  ASSERT_EQ(unit.watch.state(), LevellingState::Jammed);
  EXPECT_NEAR(unit.watch.jammed_at()->pitch, 0.0, deg_to_rad(2.5));
}

/// What a unit did in a gap nobody knows: one sample after it is not half a second.
TEST(LevellingWatch, OneLevelSampleAfterAGapIsNotLevelForLong) {
  Unit unit;
  unit.run(3.0);
  unit.turns = false;
  unit.body = deg_to_rad(6.0);
  unit.run(0.5);
  unit.has_accelerometer = false;
  unit.run(0.6);
  unit.has_accelerometer = true;
  unit.body = 0.0;
  unit.run(kTick);
  unit.body = deg_to_rad(6.0);
  unit.run(6.0);
  ASSERT_EQ(unit.watch.state(), LevellingState::Jammed);
  EXPECT_NEAR(unit.watch.jammed_at()->pitch, 0.0, deg_to_rad(2.5));
}

/// Below a degree that nobody takes away a loop aims on and on; where that ends no robot leans.
TEST(LevellingWatch, AnAimThatGrowsWhereItIsNearlyLevelIsNoLean) {
  Unit unit;
  unit.run(3.0);
  unit.turns = false;
  unit.body = deg_to_rad(1.2);
  unit.run(20.0);
  unit.body = deg_to_rad(8.0);
  unit.run(5.0);
  EXPECT_EQ(unit.watch.state(), LevellingState::Jammed);
}

/// Servos that cannot turn far are soon at their stop on a steep ramp, without a fault.
TEST(LevellingWatch, AtTheStopOfShortTravelAUnitWorks) {
  RobotModel model;
  model.max_aim = deg_to_rad(10.0);
  Unit unit{model};
  LevellingConfig config;
  config.max_angle = model.max_aim;
  unit.levelling = Levelling{config, model};
  unit.body = deg_to_rad(14.5);
  unit.run(20.0);
  EXPECT_EQ(unit.watch.state(), LevellingState::Works);
}

TEST(LevellingWatch, APlatformThatStaysTiltedIsNotLevelBeforeItsServosAreKnownToBeJammed) {
  Unit unit;
  unit.body = deg_to_rad(8.0);
  unit.run(3.0);
  EXPECT_TRUE(unit.watch.level());
  unit.turns = false;
  unit.body = 0.0;
  unit.run(0.5);
  EXPECT_EQ(unit.watch.state(), LevellingState::Works);
  EXPECT_FALSE(unit.watch.level());
  unit.run(4.0);
  ASSERT_EQ(unit.watch.state(), LevellingState::Jammed);
  unit.body = deg_to_rad(8.0);
  unit.run(2.0);
  EXPECT_FALSE(unit.watch.level()) << "it happens to feel level, yet nobody levels it";
}

}  // namespace
}  // namespace rubble::robot
