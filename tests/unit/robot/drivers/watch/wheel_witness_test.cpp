#include "robot/drivers/watch/wheel_witness.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "base/angle.h"
#include "robot/drivers/watch/scan_motion.h"
#include "tests/support/robot_scanned_room.h"

namespace rubble::robot {
namespace {

using mrpt::math::TPose2D;
using test::Wall;
using Room = test::ScannedRoom;

const TPose2D kMount{0.145, 0.0, 0.0};

TEST(ScanMotion, IsThatOfTheRobot) {
  const Room room;
  std::mt19937 random(1);
  for (const double ahead : {-0.5, -0.2, 0.0, 0.15, 0.3, 0.6}) {
    for (const double turn : {-60.0, -25.0, -10.0, 0.0, 15.0, 40.0}) {
      const TPose2D T_room_before{1.8, 1.2, 0.4};
      const double phi = deg_to_rad(turn);
      const TPose2D T_room_after =
          T_room_before + TPose2D{ahead * std::cos(0.5 * phi), ahead * std::sin(0.5 * phi), phi};
      const ScanMotion motion =
          motion_between(room.scan(T_room_before + kMount, random), room.scan(T_room_after + kMount, random), kMount);
      SCOPED_TRACE(testing::Message() << ahead << " m " << turn << " deg, fits " << motion.fit << ", " << motion.still);
      if (ahead == 0.0 && turn == 0.0) {
        EXPECT_TRUE(motion.stood());
        EXPECT_FALSE(motion.moved());
        continue;
      }
      EXPECT_FALSE(motion.stood());
      EXPECT_TRUE(motion.moved());
      EXPECT_NEAR(motion.ahead, ahead, 0.1);
      EXPECT_NEAR(rad_to_deg(motion.turn), turn, 5.0);
    }
  }
}

TEST(ScanMotion, PeopleWhoWalkByAreNoMotionOfTheRobot) {
  const Room room;
  std::mt19937 random(2);
  std::uniform_real_distribution<double> x(0.5, 4.0), y(0.3, 2.2), step(-0.5, 0.5);
  const TPose2D T_room_laser = TPose2D{1.8, 1.2, 0.4} + kMount;
  for (int i = 0; i < 300; ++i) {
    std::vector<Wall> before, after;
    for (int guest = 0; guest < 2; ++guest) {
      const Wall w{x(random), y(random), 0.0, 0.0};
      const double dx = step(random), dy = step(random);
      before.push_back({w.x1, w.y1, w.x1 + 0.3, w.y1 + 0.2});
      after.push_back({w.x1 + dx, w.y1 + dy, w.x1 + dx + 0.3, w.y1 + dy + 0.2});
    }
    const ScanMotion motion =
        motion_between(room.scan(T_room_laser, random, before), room.scan(T_room_laser, random, after), kMount);
    EXPECT_FALSE(motion.moved()) << i << ": " << motion.ahead << " m " << rad_to_deg(motion.turn) << " deg";
  }
}

TEST(ScanMotion, WhereNoWallIsInReachNothingIsSaid) {
  LaserScan empty;
  empty.angle_min = deg_to_rad(-119.5);
  empty.angle_step = 2.0 * kPi / 1024.0;
  empty.range_max = 4.0;
  empty.ranges.assign(682, std::numeric_limits<float>::infinity());
  const ScanMotion motion = motion_between(empty, empty, kMount);
  EXPECT_FALSE(motion.moved());
  EXPECT_FALSE(motion.stood());
}

/// A robot in the room: its base reports what `report` makes of what it does, its scanner sees what is so.
class SeeingRobot {
 public:
  /// At 50 Hz; reports and scans ten times a second, the scans 90 ms old.
  void run(const Drive& told, double seconds) {
    const Drive ramp{0.3, deg_to_rad(100.0)};
    for (const Stamp end = now + seconds; now < end;) {
      now = now + 0.02;
      witness.tell(told, ramp, now);
      const Drive goal = moves ? told : Drive{};
      motion.v += std::clamp(goal.v - motion.v, -ramp.v * 0.02, ramp.v * 0.02);
      motion.w += std::clamp(goal.w - motion.w, -ramp.w * 0.02, ramp.w * 0.02);
      const Drive body = slips ? Drive{} : motion;
      T_room_base.phi += body.w * 0.02;
      T_room_base.x += std::cos(T_room_base.phi) * body.v * 0.02;
      T_room_base.y += std::sin(T_room_base.phi) * body.v * 0.02;
      wheels.phi += motion.w * 0.02;
      wheels.x += std::cos(wheels.phi) * motion.v * 0.02;
      wheels.y += std::sin(wheels.phi) * motion.v * 0.02;
      before.push_back(T_room_base);
      if (before.size() > 5) before.erase(before.begin());
      ++turns;
      if (turns % 5 == 0 && reports) {
        Odometry odometry{now, wheels, motion.v, motion.w, false};
        witness.look(report ? report(odometry) : odometry, now);
      }
      if (turns % 5 == 3) witness.see(room.scan(before.front() + kMount, random), now);
      if (!witness.denial().empty() && first == Stamp::never()) first = now;
    }
  }
  /// Round and round, so that it stays in the room.
  void round(double seconds) {
    for (const Stamp end = now + seconds; now < end;) run({0.25, 0.6}, 0.5);
  }

  Room room;
  WheelWitness witness{kMount};
  std::mt19937 random{3};
  Stamp now = Stamp::from_seconds(50.0), first = Stamp::never();
  TPose2D T_room_base{1.6, 1.0, 0.0}, wheels;
  std::vector<TPose2D> before;
  Drive motion;
  bool moves = true, slips = false, reports = true;
  std::function<Odometry(Odometry)> report;
  int turns = 0;
};

TEST(WheelWitness, ReportsThatAreTrueAreNeverBlamed) {
  SeeingRobot robot;
  robot.round(30.0);
  robot.run({-0.2, 0.0}, 1.5);
  for (int i = 0; i < 10; ++i) robot.run({0.0, i % 2 == 0 ? 1.2 : -1.2}, 0.8);
  robot.run({}, 3.0);
  EXPECT_EQ(robot.witness.denial(), "");
}

TEST(WheelWitness, EncodersThatDieAreFoundWithinSeconds) {
  for (const Drive& told : {Drive{0.25, 0.6}, Drive{0.25, 0.0}, Drive{-0.2, 0.0}, Drive{0.0, 0.8}, Drive{0.0, -0.3}}) {
    for (const bool speeds : {false, true}) {  // dead, or the whole report frozen
      SCOPED_TRACE(testing::Message() << told.v << " m/s " << told.w << " rad/s " << speeds);
      SeeingRobot robot;
      robot.run(told, 2.0);
      const Odometry then{robot.now, robot.wheels, robot.motion.v, robot.motion.w, false};
      robot.report = [&](Odometry odometry) {
        odometry.pose = then.pose;
        odometry.v = speeds ? then.v : 0.0;
        odometry.w = speeds ? then.w : 0.0;
        return odometry;
      };
      robot.run(told, 3.0);
      EXPECT_THAT(robot.witness.denial(), testing::HasSubstr("encoders and scans disagree"));
      EXPECT_LT(robot.first - then.stamp, 2.5);
    }
  }
}

TEST(WheelWitness, SpeedsOfNothingBesidePlacesThatGoOnAreFoundToo) {
  SeeingRobot robot;
  robot.round(2.0);
  robot.report = [](Odometry odometry) {
    odometry.v = odometry.w = 0.0;
    return odometry;
  };
  robot.round(3.0);
  EXPECT_THAT(robot.witness.denial(), testing::HasSubstr("by their speeds"));
}

TEST(WheelWitness, ABaseThatKnowsNoSpeedsIsNotBlamedForThem) {
  SeeingRobot robot;
  robot.report = [](Odometry odometry) {
    odometry.v = odometry.w = 0.0;
    return odometry;
  };
  robot.round(20.0);
  EXPECT_EQ(robot.witness.denial(), "");
}

TEST(WheelWitness, SlipIsNoneOfIt) {
  SeeingRobot robot;
  robot.slips = true;
  robot.round(20.0);
  EXPECT_EQ(robot.witness.denial(), "");
}

TEST(WheelWitness, WheelsThatStandWithTheRobotAreNoneOfIt) {
  SeeingRobot robot;
  robot.moves = false;
  robot.round(20.0);
  EXPECT_EQ(robot.witness.denial(), "");
}

/// Somebody pushes it, its wheels locked, while it is told to stand; then it is told to drive and stands.
TEST(WheelWitness, ARobotThatIsCarriedWhileToldToStandIsNoneOfIt) {
  SeeingRobot robot;
  robot.moves = false;
  for (int i = 0; i < 100; ++i) {
    robot.T_room_base.x += i % 20 < 10 ? 0.03 : -0.03;
    robot.run({}, 0.1);
  }
  robot.run({0.25, 0.0}, 5.0);
  EXPECT_EQ(robot.witness.denial(), "");
}

TEST(WheelWitness, AStallAndASilenceOfTheBaseAreNoneOfIt) {
  SeeingRobot silent;
  silent.round(2.0);
  silent.reports = false;
  silent.round(5.0);
  EXPECT_EQ(silent.witness.denial(), "") << "the base says nothing";
  silent.reports = true;
  silent.round(5.0);
  EXPECT_EQ(silent.witness.denial(), "");
  SeeingRobot stalled;
  stalled.report = [](Odometry odometry) {
    odometry.pose = {};
    odometry.v = odometry.w = 0.0;
    odometry.stalled = true;
    return odometry;
  };
  stalled.round(5.0);
  EXPECT_EQ(stalled.witness.denial(), "");
}

/// As a line does that is as late as it may be.
TEST(WheelWitness, ReportsThatComeLateAreNoneOfIt) {
  SeeingRobot robot;
  std::vector<Odometry> on_the_way;
  robot.report = [&](const Odometry& odometry) {
    on_the_way.push_back(odometry);
    const Odometry arrived = on_the_way.front();
    if (on_the_way.size() > 3) on_the_way.erase(on_the_way.begin());
    return arrived;
  };
  for (int i = 0; i < 60; ++i) {
    robot.run({0.0, i % 2 == 0 ? 1.7 : -1.7}, 0.1 * (3 + i % 8));
    robot.run({i % 2 == 0 ? 0.3 : -0.3, 0.0}, 0.1 * (i % 7));
    robot.run({}, 0.1 * (i % 5));
  }
  EXPECT_EQ(robot.witness.denial(), "");
}

TEST(WheelWitness, APauseForgetsEverything) {
  SeeingRobot robot;
  robot.report = [](Odometry odometry) {
    odometry.pose = {};
    return odometry;
  };
  robot.round(4.0);
  EXPECT_NE(robot.witness.denial(), "");
  robot.witness.pause();
  EXPECT_EQ(robot.witness.denial(), "");
  robot.report = nullptr;
  robot.round(4.0);
  EXPECT_EQ(robot.witness.denial(), "");
}

}  // namespace
}  // namespace rubble::robot
