// Scans against wheels: whether the robot is what its file says.
#include "robot/drivers/watch/mount_witness.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "base/angle.h"
#include "robot/drivers/scanner.h"
#include "robot/logs/log.h"
#include "tests/support/long_suite.h"
#include "tests/support/robot_scanned_room.h"

namespace rubble::robot {
namespace {

using mrpt::math::TPose2D;
using testing::HasSubstr;

/// How a robot is put together, other than its file says.
struct Build {
  double yaw = 0.0;  ///< of the scanner, more than the file says [rad]
  bool upside_down = false;
  double distance = 1.0;  ///< reported per true
  double turn = 1.0;
  double grip = 1.0;  ///< of what the wheels do the robot does so much
};

const TPose2D kFileMount{0.145, 0.0, 0.0};

/// A robot in a room, which reports and scans ten times a second; the scans arrive 90 ms late.
class BuiltRobot {
 public:
  explicit BuiltRobot(const Build& given) : build(given) {}

  void run(double v, double w, double seconds) {
    for (const Stamp end = now + seconds; now < end;) {
      now = now + 0.1;
      const double grip =
          build.grip < 1.0 ? build.grip * std::uniform_real_distribution<double>(0.0, 2.0)(random) : 1.0;
      step(T_room_base, grip * v, grip * w);
      step(wheels, build.distance * v, build.turn * w);
      gone += std::abs(v) * 0.1;
      turned += std::abs(w) * 0.1;
      LaserScan scan = room.scan(T_room_base + TPose2D{kFileMount.x, kFileMount.y, build.yaw}, random);
      scan.stamp = now;
      if (build.upside_down) turn_over(scan);
      if (!stands_at || scans.empty()) scans.push_back(scan);
      witness.look({now, wheels, build.distance * v, build.turn * w, false}, now);
      if (!scans.empty()) witness.see(scans.back(), now + 0.05);
      if (witness.finding()) return;
    }
  }
  /// To and fro and round, as one who looks around.
  void look_around(int times) {
    for (int i = 0; i < times && !witness.finding(); ++i) {
      run(0.2, 0.0, 4.0);
      run(0.0, 0.6, 3.0);
      run(-0.2, 0.0, 4.0);
      run(0.0, -0.6, 3.0);
    }
  }
  std::string finding() const { return witness.finding() ? witness.finding()->line() : ""; }

  Build build;
  test::ScannedRoom room;
  MountWitness witness{kFileMount};
  std::mt19937 random{5};
  Stamp now = Stamp::from_seconds(50.0);
  TPose2D T_room_base{1.6, 1.2, 0.3}, wheels;
  std::vector<LaserScan> scans;
  bool stands_at = false;  ///< its scanner shows the first place for ever
  double gone = 0.0, turned = 0.0;

 private:
  static void step(TPose2D& pose, double v, double w) {
    pose = pose + TPose2D{0.1 * v * std::cos(0.05 * w), 0.1 * v * std::sin(0.05 * w), 0.1 * w};
  }
};

TEST(MountWitness, ARobotAsItsFileSaysIsNeverBlamed) {
  for (const Build& build :
       {Build{}, Build{deg_to_rad(20.0)}, Build{0.0, false, 1.3, 1.3}, Build{0.0, false, 0.8, 0.8}}) {
    BuiltRobot robot(build);
    robot.look_around(10);
    for (int i = 0; i < 20; ++i) robot.run(i % 2 == 0 ? 0.3 : -0.3, 0.5, 2.0);
    EXPECT_EQ(robot.finding(), "");
  }
}

TEST(MountWitness, SlipIsNoneOfIt) {
  for (const double grip : {0.0, 0.3, 0.6, 0.9}) {
    BuiltRobot robot(Build{0.0, false, 1.0, 1.0, grip});
    robot.look_around(10);
    EXPECT_EQ(robot.finding(), "") << grip;
  }
}

TEST(MountWitness, AScannerThatLooksElsewhereIsFoundWithinTwoMetres) {
  for (const double yaw : {180.0, 90.0, -90.0, 135.0}) {
    BuiltRobot robot(Build{deg_to_rad(yaw)});
    robot.look_around(10);
    EXPECT_THAT(robot.finding(), HasSubstr("devices.urg.yaw_deg")) << yaw;
    EXPECT_LT(robot.gone, 2.0) << yaw;
    if (yaw == 180.0) {
      EXPECT_LT(robot.gone, 1.0);
      EXPECT_THAT(robot.finding(), HasSubstr("by about 180 deg"));
    }
    const double said = std::stod(robot.finding().substr(robot.finding().find("by about ") + 9));
    EXPECT_NEAR(wrap_angle(deg_to_rad(yaw + said)), 0.0, deg_to_rad(31.0)) << "lowered by it the file is right";
  }
}

TEST(MountWitness, AScannerThatHangsUpsideDownIsFoundInTwoTurnsOnTheSpot) {
  BuiltRobot robot(Build{0.0, true});
  robot.look_around(10);
  EXPECT_THAT(robot.finding(), HasSubstr("devices.urg.upside_down"));
  EXPECT_LT(robot.turned, 4.0 * kPi);
}

TEST(MountWitness, AScaleThatIsWrongIsFoundEitherWay) {
  for (const double scale : {0.5, 2.0}) {
    BuiltRobot far(Build{0.0, false, scale, 1.0}), round(Build{0.0, false, 1.0, scale});
    far.look_around(20);
    round.look_around(20);
    EXPECT_THAT(far.finding(), HasSubstr("devices.base.distance_scale")) << scale;
    EXPECT_THAT(round.finding(), HasSubstr("devices.base.turn_scale")) << scale;
  }
}

TEST(MountWitness, WheelsOfAnotherRobotAreFoundBehindABreakOfTheLineOnly) {
  for (const bool breaks : {false, true}) {
    BuiltRobot robot(Build{});
    robot.look_around(2);
    robot.build.grip = 0.0;  // it is another one that drives
    if (breaks) robot.witness.broke(robot.now);
    const Stamp then = robot.now;
    robot.look_around(3);
    EXPECT_EQ(robot.finding().find("another robot's base") != std::string::npos, breaks) << robot.finding();
    if (breaks) {
      EXPECT_LT(robot.now - then, 10.0);
    }
  }
}

TEST(MountWitness, WhatWasFoundIsForgottenWhenCleared) {
  BuiltRobot robot(Build{kPi});
  robot.look_around(3);
  EXPECT_NE(robot.finding(), "");
  robot.witness.clear();
  robot.build.yaw = 0.0;
  robot.look_around(3);
  EXPECT_EQ(robot.finding(), "");
}

TEST(MountWitness, AScannerThatIsTurnedOverTwiceIsAsBefore) {
  const test::ScannedRoom room;
  std::mt19937 random(1);
  LaserScan scan = room.scan({1.5, 1.0, 0.2}, random);
  scan.beam_period = 1e-4;
  scan.stamp = Stamp::from_seconds(5.0);
  LaserScan twice = scan;
  turn_over(twice);
  const std::size_t last = scan.ranges.size() - 1;
  EXPECT_EQ(twice.bearing(0), -scan.bearing(last));
  EXPECT_EQ(twice.beam_stamp(0), scan.beam_stamp(last));
  EXPECT_NEAR(twice.beam_stamp(last) - scan.beam_stamp(0), 0.0, 1e-8);
  turn_over(twice);
  EXPECT_NEAR(twice.angle_min, scan.angle_min, 1e-12);
  EXPECT_NEAR(twice.stamp - scan.stamp, 0.0, 1e-8);
  for (std::size_t i = 0; i <= last; ++i) EXPECT_TRUE(twice.ranges[i] == scan.ranges[i] || std::isnan(scan.ranges[i]));
}

/// Which way the log's own corrected poses say that it went lately, by its heading then [m].
double went_ahead(const Trajectory& reference, Stamp now) {
  const auto at = [&](Stamp when) {
    return std::lower_bound(reference.begin(), reference.end(), when,
                            [](const auto& one, Stamp stamp) { return one.stamp < stamp; });
  };
  const auto from = at(now - 3.0), to = at(now);  // about as long as the three stretches of a finding
  if (from == reference.end() || to == reference.end()) return 0.0;
  return std::cos(from->pose.phi) * (to->pose.x - from->pose.x) +
         std::sin(from->pose.phi) * (to->pose.y - from->pose.y);
}

/// Where one is raised the log's corrected poses, too, go the other way than its wheels (freiburg-079). Those within
/// ten seconds are one: the first would have held the robot.
TEST(MountWitness, RecordedDrivesRaiseNoFalseAlarm) {
  const char* data = std::getenv("RUBBLE_DATA");
  if (data == nullptr) GTEST_SKIP() << "set RUBBLE_DATA to the folder of public data";
  std::size_t place = 0;
  for (const char* name : {"freiburg-079-corrected.log.gz", "aces-corrected.log.gz", "csail-corrected.log.gz",
                           "exp1.dat", "fhw-corrected.log.gz", "intel-corrected.log.gz"}) {
    if (!is_tried(place++)) continue;
    SCOPED_TRACE(name);
    ReplayRobot replay(std::string(data) + "/logs/" + name);
    const auto& mount = replay.model().T_base_laser;
    MountWitness witness({mount.x, mount.y, mount.yaw});
    int scans = 0, alarms = 0, false_alarms = 0;
    Stamp raised = Stamp::never();
    TPose2D wheels, before;
    while (const auto inputs = replay.read()) {
      for (const Odometry& report : inputs->odometry) {
        before = std::exchange(wheels, report.pose);
        witness.look(report, inputs->now);
        if (!witness.finding()) continue;
        alarms += raised == Stamp::never() || inputs->now - raised > 10.0 ? 1 : 0;
        raised = inputs->now;
        const double step = (wheels - before).x;
        false_alarms += went_ahead(replay.reference(), inputs->now) * step >= 0.0 ? 1 : 0;
        witness.clear();
      }
      for (const LaserScan& scan : inputs->scans) {
        witness.see(scan, inputs->now);
        ++scans;
      }
    }
    EXPECT_GT(scans, 400);
    EXPECT_EQ(false_alarms, 0);
    EXPECT_LE(alarms, 3);
    std::printf("%s: %d scans, %d alarms, %d of them false\n", name, scans, alarms, false_alarms);
  }
}

}  // namespace
}  // namespace rubble::robot
