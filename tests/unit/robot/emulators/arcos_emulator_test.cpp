// The emulated base: what it does with a client's orders, step by step.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/planar.h"
#include "tests/support/pioneer_wire.h"

namespace rubble::robot {
namespace {

TEST(ArcosEmulator, MotorsThatAreSwitchedOffStopAtOnceWhateverIsSaidBehindThat) {
  for (const int behind : {arcos::kStop, arcos::kPulse, arcos::kEmergencyStop}) {
    Wire wire;
    wire.run(1.0);
    wire.go(0.4, 0.0);
    wire.run(4.0);
    wire.base.receive(arcos::command(arcos::kEnable, 0) + arcos::command(static_cast<arcos::Command>(behind)),
                      wire.now);
    wire.base.advance(wire.now + kStep);
    EXPECT_EQ(wire.base.motion().v, 0.0);
  }
}

TEST(ArcosEmulator, ASyncOutOfItsOrderStartsOver) {
  using namespace arcos;
  const auto answers = [](const std::vector<Command>& commands) {
    ArcosEmulator base{ArcosEmulatorSettings{}};
    base.client_came(Stamp{0});
    std::vector<std::string> out;
    for (const Command number : commands) {
      base.receive(command(number), Stamp{0});
      out.push_back(base.take_output());
    }
    out.emplace_back(base.open() ? "open" : "closed");
    return out;
  };
  const std::string zero = command(kSync0), one = command(kSync1);
  const std::string two = packet(encode(Identity{"MobileSim", "Pioneer", "p3at-sh"}));
  using testing::ElementsAre;
  // The second SYNC1 is no OPEN: SYNC2 has not been answered yet.
  EXPECT_THAT(answers({kSync0, kSync1, kSync1, kSync2}), ElementsAre(zero, one, "", "", "closed"));
  EXPECT_THAT(answers({kSync0, kSync2, kSync1}), ElementsAre(zero, "", "", "closed"));
  EXPECT_THAT(answers({kSync0, kSync1, kSync2, kSync2, kOpen}), ElementsAre(zero, one, two, "", "", "closed"));
  EXPECT_THAT(answers({kSync0, kSync1, kSync0, kSync1, kSync2, kOpen}),
              ElementsAre(zero, one, zero, one, two, "", "open"));
}

TEST(ArcosEmulator, OrdersToTheSidesAndToTheWholeEndEachOther) {
  Wire wire;
  wire.run(1.0);
  wire.go(0.0, 0.0);
  wire.cut = true;
  const auto say = [&](const std::string& packet) {
    for (int i = 0; i < 20; ++i) {
      wire.base.receive(i == 0 ? packet : arcos::command(arcos::kPulse), wire.now);
      wire.run(0.1);
    }
    return wire.base.motion();
  };
  const Drive turning = say(arcos::command(arcos::kWheelSpeeds, 0x050A));  // left 5, right 10
  EXPECT_NEAR(turning.v, 0.15, 1e-9);
  EXPECT_GT(turning.w, 0.1);
  const Drive straight = say(arcos::command(arcos::kVelocity, 200));
  EXPECT_NEAR(straight.v, 0.2, 1e-9);
  EXPECT_NEAR(straight.w, 0.0, 1e-9);
  const Drive sides = say(arcos::command(arcos::kWheelSpeeds, 0x0505));
  EXPECT_NEAR(sides.v, 0.1, 1e-9);
  EXPECT_NEAR(sides.w, 0.0, 1e-9);
}

TEST(ArcosEmulator, AHeadInJunkDoesNotDeafenIt) {
  Wire wire;
  wire.run(1.0);
  wire.go(0.0, 0.0);
  wire.run(0.5);
  wire.cut = true;
  wire.base.receive("\xfa\xfb\x60", wire.now);
  double moved_after = -1.0;
  for (int i = 0; i < 6000 && moved_after < 0.0; ++i) {
    if (i % 500 == 0) wire.base.receive(arcos::command(arcos::kVelocity, 200), wire.now);
    wire.step();
    if (wire.base.motion().v > 0.0) moved_after = kStep * i;
  }
  EXPECT_GE(moved_after, 0.0);
  EXPECT_LE(moved_after, 0.3);
}

TEST(ArcosEmulator, ARealRobotIsNoSimulator) {
  using namespace arcos;
  ArcosEmulatorSettings settings;
  play_hardware(settings);
  Wire wire(settings);
  wire.run(1.0);
  EXPECT_NE(wire.driver.identity().name, "MobileSim");
  EXPECT_NE(wire.driver.configuration().serial, "SIM");
  EXPECT_EQ(wire.driver.configuration().name, wire.driver.identity().name);
  wire.base.receive(sim_set_pose(1500, -2500, 90), wire.now);
  EXPECT_FALSE(wire.base.take_placed());
}

TEST(ArcosEmulator, SynchronisesOnlyInOrder) {
  using namespace arcos;
  ArcosEmulator base({});
  const Stamp now{0};
  base.client_came(now);
  base.receive(command(kSync1), now);
  EXPECT_EQ(base.take_output(), "");
  base.receive(command(kSync0), now);
  EXPECT_EQ(base.take_output(), command(kSync0));
  base.receive(command(kSync1), now);
  EXPECT_EQ(base.take_output(), command(kSync1));
  base.receive(command(kSync2), now);
  EXPECT_EQ(base.take_output(), packet(encode(Identity{"MobileSim", "Pioneer", "p3at-sh"})));
  base.receive(command(kOpen), now);
  EXPECT_TRUE(base.open());
}

TEST(ArcosEmulator, HeadAndMoveEndWhereTheyWereSent) {
  Wire wire;
  wire.run(1.0);
  wire.go(0.0, 0.0);
  wire.base.receive(arcos::command(arcos::kHead, -170), wire.now);
  wire.cut = true;  // the driver's own set points would take over
  for (int i = 0; i < 60; ++i) {
    wire.base.receive(arcos::command(arcos::kPulse), wire.now);
    wire.run(0.1);
  }
  EXPECT_NEAR(rad_to_deg(wrap_angle(wire.truth.phi - deg_to_rad(-170.0))), 0.0, 3.0);
  wire.base.receive(arcos::command(arcos::kMove, 500), wire.now);
  const mrpt::math::TPose2D start = wire.truth;
  for (int i = 0; i < 60; ++i) {
    wire.base.receive(arcos::command(arcos::kPulse), wire.now);
    wire.run(0.1);
  }
  EXPECT_NEAR(length(wire.truth.x - start.x, wire.truth.y - start.y), 0.5, 0.06);
}

/// What its accelerometer would feel as a blow, an explorer would take for an obstacle.
TEST(ArcosEmulator, ACableThatIsPulledOutBrakesByTheRamp) {
  Wire wire;
  wire.run(1.0);
  wire.go(0.4, 0.0);
  wire.run(3.0);
  const double v = wire.base.motion().v;
  ASSERT_NEAR(v, 0.4, 1e-3);
  wire.base.client_left(wire.now);
  EXPECT_FALSE(wire.base.brakes_hard());
  wire.base.advance(wire.now + 0.1);
  EXPECT_NEAR(wire.base.motion().v, v - 0.1 * 0.3, 2e-3);
  wire.base.advance(wire.now + 2.0);
  EXPECT_EQ(wire.base.motion().v, 0.0);
}

/// A robot that is heavy: its wheels follow the set points late, and what is measured is up to 100 ms old.
TEST(ArcosEmulator, HeadAndMoveDoNotHunt) {
  constexpr double kLag = 0.1, kStep = 0.01;
  for (const auto& [number, value] : {std::pair(arcos::kHead, 45),
                                      {arcos::kHead, -90},
                                      {arcos::kTurnBy, 30},
                                      {arcos::kMove, 500},
                                      {arcos::kMove, -500}}) {
    SCOPED_TRACE(std::to_string(number) + " " + std::to_string(value));
    ArcosEmulator base({});
    Stamp now{0};
    base.client_came(now);
    for (const auto order : {arcos::kSync0, arcos::kSync1, arcos::kSync2}) base.receive(arcos::command(order), now);
    base.receive(arcos::command(arcos::kOpen), now);
    base.receive(arcos::command(arcos::kEnable, 1), now);
    base.receive(arcos::command(number, value), now);
    const bool turns = number != arcos::kMove;
    const double goal = turns ? deg_to_rad(value) : 1e-3 * value;
    mrpt::math::TPose2D pose;
    Drive wheels;
    double farthest = 0.0, last_moved = 0.0;
    for (int i = 1; i <= 1000; ++i) {
      now = now + kStep;
      if (i % 10 == 0) base.receive(arcos::command(arcos::kPulse), now);
      base.advance(now);
      wheels.v += (base.motion().v - wheels.v) * kStep / kLag;
      wheels.w += (base.motion().w - wheels.w) * kStep / kLag;
      pose.x += wheels.v * kStep;
      pose.phi += wheels.w * kStep;
      if (i % 10 == 0) base.measure({now, pose, wheels.v, wheels.w, false}, now);
      base.take_output();
      const double there = (turns ? pose.phi : pose.x) / goal;
      farthest = std::max(farthest, there);
      if (std::abs(wheels.v) > 0.005 || std::abs(wheels.w) > deg_to_rad(0.5)) last_moved = kStep * i;
    }
    EXPECT_LT(farthest, 1.02) << "it shoots over";
    EXPECT_NEAR((turns ? pose.phi : pose.x), goal, turns ? deg_to_rad(0.4) : 0.003);
    EXPECT_LT(last_moved, 6.0) << "it never rests";
  }
}

/// A robot between two walls, told to drive or turn farther than they let it, and back whenever the order happens to
/// come.
TEST(ArcosEmulator, AWayBackFromAWallIsAsLongAsItWasSent) {
  constexpr double kLag = 0.1, kStep = 0.01, kStallTime = 0.2, kRelaxTime = 0.2;
  for (const bool turns : {false, true}) {
    for (int pushed = 0; pushed < 20; ++pushed) {
      const double wall = turns ? deg_to_rad(60.0) : 1.0, back = turns ? deg_to_rad(40.0) : 0.5;
      ArcosEmulator base({});
      Stamp now{0};
      base.client_came(now);
      for (const auto order : {arcos::kSync0, arcos::kSync1, arcos::kSync2}) base.receive(arcos::command(order), now);
      base.receive(arcos::command(arcos::kOpen), now);
      base.receive(arcos::command(arcos::kEnable, 1), now);
      base.receive(turns ? arcos::command(arcos::kHead, 120) : arcos::command(arcos::kMove, 3000), now);
      double way = 0.0, speed = 0.0, since_push = 0.0, relaxed = 0.0, turned_at = 0.0, farthest = 0.0;
      double reported = 0.0, reported_speed = 0.0;
      Stamp reported_at{0};
      bool stalled = false, ordered = false;
      int at_wall = 0;
      for (int i = 1; i <= 2500; ++i) {
        now = now + kStep;
        if (i % 10 == 0) base.receive(arcos::command(arcos::kPulse), now);
        base.advance(now);
        const double asked = relaxed > 0.0 ? 0.0 : turns ? base.motion().w : base.motion().v;
        speed += (asked - speed) * kStep / kLag;
        way += speed * kStep;
        const bool blocked = way >= wall && asked > 0.02;
        if (way >= wall) way = wall, speed = std::min(speed, 0.0);
        since_push = blocked ? since_push + kStep : 0.0;
        relaxed = std::max(0.0, relaxed - kStep);
        if (since_push > kStallTime) stalled = true, relaxed = kRelaxTime;
        if (asked < 0.0) stalled = false;
        at_wall += way >= wall ? 1 : 0;
        if (!ordered && at_wall > 13 * pushed) {
          ordered = true;
          // HEAD names a heading; MOVE counts from where the client must take the robot to be.
          turned_at = turns ? wall : reported + reported_speed * (now - reported_at);
          base.receive(turns ? arcos::command(arcos::kHead, 20) : arcos::command(arcos::kMove, -500), now);
        }
        if (ordered) farthest = std::max(farthest, turned_at - way);
        const mrpt::math::TPose2D pose = turns ? mrpt::math::TPose2D{0, 0, way} : mrpt::math::TPose2D{way, 0, 0};
        if (i % 10 == 0) {
          base.measure({now, pose, turns ? 0.0 : speed, turns ? speed : 0.0, stalled}, now);
          reported = way, reported_speed = speed, reported_at = now;
        }
        base.take_output();
      }
      SCOPED_TRACE((turns ? "turn" : "move") + std::string(", pushed for ") + std::to_string(0.13 * pushed) + " s");
      ASSERT_TRUE(ordered);
      EXPECT_LT(farthest, 1.03 * back) << "it shoots over";
      EXPECT_NEAR(turned_at - way, back, turns ? deg_to_rad(0.5) : 0.005);
    }
  }
}

/// An emulator that is open, its motors on, and a robot whose wheels follow the set points late.
struct Heavy {
  Heavy() {
    base.client_came(now);
    for (const auto order : {arcos::kSync0, arcos::kSync1, arcos::kSync2}) base.receive(arcos::command(order), now);
    base.receive(arcos::command(arcos::kOpen), now);
    base.receive(arcos::command(arcos::kEnable, 1), now);
  }
  void step() {
    constexpr double kLag = 0.1, kStep = 0.001;
    now = now + kStep;
    ++steps;
    if (steps % 500 == 0) base.receive(arcos::command(arcos::kPulse), now);
    base.advance(now);
    wheels.v += (base.motion().v - wheels.v) * kStep / kLag;
    wheels.w += (base.motion().w - wheels.w) * kStep / kLag;
    way += wheels.v * kStep;
    turn += wheels.w * kStep;
    if (steps % 100 == 0) base.measure({now, {way, 0.0, turn}, wheels.v, wheels.w, false}, now);
    base.take_output();
  }
  ArcosEmulator base{ArcosEmulatorSettings{}};
  Stamp now{0};
  Drive wheels;
  double way = 0.0, turn = 0.0;
  int steps = 0;
};

/// As clients do that say in every cycle where they want to go.
TEST(ArcosEmulator, AWayThatIsOrderedAgainAndAgainIsGone) {
  for (const int every_ms : {5, 20, 50}) {
    for (const int turn_accel : {10, 100}) {
      SCOPED_TRACE(std::to_string(every_ms) + " ms, " + std::to_string(turn_accel) + " deg/s2");
      Heavy turning;
      for (const int sign : {1, -1})
        turning.base.receive(arcos::command(arcos::kSetTurnAcceleration, sign * turn_accel), turning.now);
      for (int i = 0; i < 10000; ++i) {
        if (i % every_ms == 0) turning.base.receive(arcos::command(arcos::kHead, 90), turning.now);
        turning.step();
      }
      EXPECT_NEAR(rad_to_deg(turning.turn), 90.0, 3.0);
      Heavy driving;
      driving.base.receive(arcos::command(arcos::kSetSpeed, 300), driving.now);
      for (int i = 0; i < 4000; ++i) {
        if (i % every_ms == 0) driving.base.receive(arcos::command(arcos::kMove, 1000), driving.now);
        driving.step();
      }
      EXPECT_GT(driving.way, 0.8) << "each MOVE is a metre from where the robot is";
    }
  }
}

TEST(ArcosEmulator, MoveCountsFromWhereTheRobotIsWhenItIsOrdered) {
  for (const int late_ms : {1, 20, 50, 80, 99}) {
    SCOPED_TRACE(late_ms);
    Heavy robot;
    robot.base.receive(arcos::command(arcos::kVelocity, 300), robot.now);
    for (int i = 0; i < 3000 + late_ms; ++i) robot.step();
    ASSERT_NEAR(robot.wheels.v, 0.3, 1e-3);
    const double there = robot.way;
    robot.base.receive(arcos::command(arcos::kMove, 600), robot.now);
    for (int i = 0; i < 8000; ++i) robot.step();
    EXPECT_NEAR(robot.way - there, 0.6, 0.005);
    EXPECT_NEAR(robot.wheels.v, 0.0, 1e-3);
  }
}

TEST(ArcosEmulator, ASimulatorsClientCanSetThePose) {
  Wire wire;
  wire.run(1.0);
  wire.base.receive(arcos::sim_set_pose(1500, -2500, 90), wire.now);
  const auto placed = wire.base.take_placed();
  ASSERT_TRUE(placed);
  EXPECT_DOUBLE_EQ(placed->x, 1.5);
  EXPECT_DOUBLE_EQ(placed->y, -2.5);
  EXPECT_DOUBLE_EQ(placed->phi, deg_to_rad(90.0));
  EXPECT_FALSE(wire.base.take_placed());
}

}  // namespace
}  // namespace rubble::robot
