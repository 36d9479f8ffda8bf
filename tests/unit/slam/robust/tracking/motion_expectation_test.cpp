#include "slam/robust/tracking/motion_expectation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/planar.h"
#include "slam/robust/robust_mapper.h"
#include "tests/support/slam_key_frames.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kPeriod = 0.1;  // between scans [s]

/// Wheels that say `step` from scan to scan, and what was found of it.
class Drive {
 public:
  ExpectedMotion hear(const TPose2D& step) {
    ++scans_;
    const Stamp now = Stamp{0} + kPeriod * scans_;
    T_odom_base_ = T_odom_base_ + step;
    robot::Odometry report;
    report.stamp = now;
    report.pose = T_odom_base_;
    motion_.hear(report, now);
    scan_.stamp = now;
    return motion_.expect(scan_);
  }
  void found(const TPose2D& step) {
    motion_.found(step, kPeriod, false);
    motion_.scan_taken(scan_.middle());
  }

 private:
  MotionExpectation motion_{kPeriod};
  robot::LaserScan scan_;
  TPose2D T_odom_base_;
  int scans_ = 0;
};

const TPose2D kCurve(0.03, 0.0, 0.05);
const TPose2D kAhead(0.03, 0.0, 0.0);

TEST(MotionExpectation, WheelsThatTurnInVainRollInVain) {
  for (const double share : {0.0, 0.2, 0.4, 0.6, 1.0}) {
    SCOPED_TRACE(share);
    Drive drive;
    ExpectedMotion motion;
    for (int scan = 0; scan < 10; ++scan) {
      motion = drive.hear(kCurve);
      drive.found({share * kCurve.x, 0.0, share * kCurve.phi});
    }
    EXPECT_NEAR(motion.T_last_now.x, kCurve.x, 1e-9) << "what the wheels say stays known";
    EXPECT_NEAR(motion.in_vain, share < 0.5 ? 1.0 - share : 0.0, 1e-9);
    EXPECT_NEAR(motion.believed().x, share < 0.5 ? share * kCurve.x : kCurve.x, 1e-9);
    EXPECT_NEAR(motion.believed().phi, kCurve.phi, 1e-9) << "the heading is the scan's to tell";
  }
}

/// Reports 50 times a second that jump once; a scan ten times a second sweeps for 66 ms. Wherever in a sweep or between
/// two the jump lies, no step of a scan believes a part of it.
TEST(MotionExpectation, AJumpIsNotBelievedWhereverInAScanItLies) {
  const TPose2D jump(0.75, -0.45, 1.2);
  for (int jumps_at = 40; jumps_at < 50; ++jumps_at) {
    SCOPED_TRACE("report " + std::to_string(jumps_at));
    MotionExpectation motion(kPeriod);
    robot::LaserScan scan;
    scan.beam_period = 0.066 / 682;
    scan.ranges.assign(682, 1.0F);
    TPose2D T_odom_base;
    int not_told = 0;
    for (int tick = 0; tick < 100; ++tick) {
      const Stamp now = Stamp{0} + 0.02 * tick;
      T_odom_base = T_odom_base + (tick == jumps_at ? jump : TPose2D(0.004, 0.0, 0.01));
      robot::Odometry report;
      report.stamp = now;
      report.pose = T_odom_base;
      motion.hear(report, now);
      if (tick < 10 || tick % 5 != 0) continue;
      scan.stamp = now - 0.09;
      const ExpectedMotion expected = motion.expect(scan);
      not_told += tick > 10 && !expected.told ? 1 : 0;
      if (tick > 10 && expected.told) {
        EXPECT_LT(length(expected.T_last_now.x, expected.T_last_now.y), 0.1) << "tick " << tick;
        EXPECT_LT(std::abs(expected.T_last_now.phi), 0.2) << "tick " << tick;
      }
      motion.found({0.02, 0.0, 0.05}, kPeriod, false);
      motion.scan_taken(scan.middle());
    }
    EXPECT_GE(not_told, 1);
    EXPECT_LE(not_told, 2);
  }
}

/// Logs of rare scans have clocks that are coarse: true steps of the wheels look like 3 to 8 m/s and rad/s there, from
/// one report to the next, several of them between two scans. A step of 20 m/s is none.
TEST(MotionExpectation, StepsOfACoarseClockAreBelieved) {
  for (const TPose2D& step : {TPose2D(0.8, 0.0, 0.0), TPose2D(0.05, 0.0, 1.06), TPose2D(2.5, 0.0, 0.0)}) {
    SCOPED_TRACE(step.asString());
    constexpr double kInterval = 0.125;
    MotionExpectation motion(kPeriod);
    robot::LaserScan scan;
    TPose2D T_odom_base;
    ExpectedMotion expected;
    for (int report_no = 0; report_no <= 40; ++report_no) {
      T_odom_base = T_odom_base + (report_no == 38 ? step : TPose2D(0.05, 0.0, 0.0));
      robot::Odometry report;
      report.stamp = Stamp{0} + kInterval * report_no;
      report.pose = T_odom_base;
      motion.hear(report, report.stamp);
      if (report_no % 8 != 0) continue;
      scan.stamp = report.stamp;
      expected = motion.expect(scan);
      motion.found(expected.T_last_now, 8 * kInterval, false);
      motion.scan_taken(scan.middle());
    }
    EXPECT_EQ(expected.told, step.x < 1.0);
    EXPECT_EQ(motion.jumps(), step.x < 1.0 ? 0U : 1U);
  }
}

/// One jump does not make those that follow it suspect, however fast the robot is.
TEST(MotionExpectation, AfterAJumpAFastRobotIsBelievedAgain) {
  Drive drive;
  int not_told = 0;
  for (int scan = 0; scan < 60; ++scan) {
    const TPose2D step(scan == 20 ? 3.4 : 0.4, 0.0, 0.0);
    const bool told = drive.hear(step).told;
    not_told += scan > 1 && !told ? 1 : 0;
    drive.found({0.4, 0.0, 0.0});
  }
  EXPECT_GE(not_told, 1);
  EXPECT_LE(not_told, 2);
}

/// A robot that frees itself drives straight on, and gets there: most of such ways are true.
TEST(MotionExpectation, WheelsThatRollStraightAreBelievedWhateverTheyTurnedBefore) {
  Drive drive;
  for (int scan = 0; scan < 10; ++scan) {
    drive.hear(kCurve);
    drive.found({});
  }
  EXPECT_EQ(drive.hear(kAhead).in_vain, 0.0);
  drive.found(kAhead);
  EXPECT_GT(drive.hear(kCurve).in_vain, 0.8);
}

TEST(MotionExpectation, WheelsThatTurnTheRobotAgainAreBelievedWithinASecond) {
  Drive drive;
  for (int scan = 0; scan < 10; ++scan) {
    drive.hear(kCurve);
    drive.found({});
  }
  for (int scan = 0; scan < 10; ++scan) {
    drive.hear(kCurve);
    drive.found(kCurve);
  }
  EXPECT_EQ(drive.hear(kCurve).in_vain, 0.0);
}

TEST(MotionExpectation, LittleTurnsSayNothingOfTheFloor) {
  Drive straight;
  for (int scan = 0; scan < 50; ++scan) {
    EXPECT_EQ(straight.hear({0.03, 0.0, 0.002}).in_vain, 0.0);
    straight.found({0.03, 0.0, 0.0});
  }
}

/// On paper between two walls that look the same all along, wheels that curve say a metre; the scan says only that the
/// robot does not turn. Where it does turn, the same wheels are believed.
TEST(MotionExpectation, ARobotThatSlipsInABareCorridorStands) {
  robot::RobotModel model;
  const slam_test::World corridor{{{-20.0, 0.7}, {20.0, 0.7}}, {{-20.0, -0.7}, {20.0, -0.7}}};
  const auto places = slam_test::places_along({{0.0, 0.0}, {3.0, 0.0}}, 0.3);
  for (const bool stands : {true, false}) {
    SCOPED_TRACE(stands);
    KeyFrames frames;
    for (std::size_t i = 0; i < places.size(); ++i) slam_test::add_key_frame(frames, corridor, places, 0.0, model);
    LocalTracker tracker(suited_to(model.laser, {}).tracker);
    tracker.redraw(frames, frames.last(), nullptr);
    Drive drive;
    TPose2D T_frame_now, truth;
    double way = 0.0;
    for (int scan = 0; scan < 60; ++scan) {
      const TPose2D wheels(0.02, 0.0,
                           scan / 10 % 2 == 0 ? 0.045 : -0.045);  // left and right, as a robot that frees itself
      if (!stands) truth = truth + wheels;
      const ExpectedMotion motion = drive.hear(wheels);
      const Cloud cloud = slam_test::cloud_at(corridor, places.back() + truth, model);
      const TPose2D found = tracker.track(frames, cloud, motion, T_frame_now, nullptr).fit.pose;
      drive.found(found - T_frame_now);
      T_frame_now = found;
      way += wheels.x;
    }
    EXPECT_GT(way, 1.1);
    EXPECT_NEAR(T_frame_now.x, truth.x, 0.15);
    EXPECT_NEAR(T_frame_now.y, truth.y, 0.02);
  }
}

}  // namespace
}  // namespace rubble::slam
