// Scans that wait for the odometry that follows them.
#include "slam/scan/waiting_scans.h"

#include <gtest/gtest.h>

namespace rubble::slam {
namespace {

robot::LaserScan scan_at(double seconds) {
  robot::LaserScan scan;
  scan.stamp = Stamp::from_seconds(seconds);
  scan.beam_period = 0.01;
  scan.angle_step = 0.1;
  scan.ranges.assign(11, 1.0f);  // a sweep of 0.1 s
  return scan;
}

robot::Odometry odometry_at(double seconds, double x) {
  robot::Odometry odometry;
  odometry.stamp = Stamp::from_seconds(seconds);
  odometry.pose = {x, 0.0, 0.0};
  return odometry;
}

TEST(WaitingScans, GivesNothingWhenEmpty) {
  const WaitingScans queue;
  EXPECT_FALSE(queue.ready(OdometryTrack(), Stamp::from_seconds(100.0)));
}

TEST(WaitingScans, LeavesOutWhatIsEmptyOrNotYounger) {
  WaitingScans queue;
  robot::LaserScan empty = scan_at(0.5);
  empty.ranges.clear();
  EXPECT_FALSE(queue.add(empty));
  EXPECT_TRUE(queue.add(scan_at(1.0)));
  EXPECT_FALSE(queue.add(scan_at(1.0)));
  EXPECT_FALSE(queue.add(scan_at(0.9)));
  EXPECT_TRUE(queue.add(scan_at(1.1)));
  queue.take();
  queue.take();
  EXPECT_FALSE(queue.add(scan_at(1.1)));  // also when it has left the queue
}

TEST(WaitingScans, AScanWaitsForOdometryFromAfterTheMiddleOfItsSweep) {
  WaitingScans queue;
  OdometryTrack odometry;
  ASSERT_TRUE(queue.add(scan_at(1.0)));
  const Stamp now = Stamp::from_seconds(1.1);
  odometry.add(odometry_at(1.0, 0.0));
  EXPECT_FALSE(queue.ready(odometry, now));
  odometry.add(odometry_at(1.05, 0.0));
  EXPECT_TRUE(queue.ready(odometry, now));
}

TEST(WaitingScans, AScanDoesNotWaitForEver) {
  WaitingScans queue;
  ASSERT_TRUE(queue.add(scan_at(1.0)));
  const double middle = queue.front().middle().seconds();
  EXPECT_FALSE(queue.ready(OdometryTrack(), Stamp::from_seconds(middle + 0.99 * OdometryTrack::kMaxExtrapolation)));
  EXPECT_TRUE(queue.ready(OdometryTrack(), Stamp::from_seconds(middle + 1.01 * OdometryTrack::kMaxExtrapolation)));
}

TEST(WaitingScans, GivesScansInTheirOrder) {
  WaitingScans queue;
  for (const double t : {1.0, 1.1, 1.3}) ASSERT_TRUE(queue.add(scan_at(t)));
  for (const double t : {1.0, 1.1, 1.3}) EXPECT_EQ(queue.take().stamp, Stamp::from_seconds(t));
  EXPECT_FALSE(queue.ready(OdometryTrack(), Stamp::from_seconds(100.0)));
}

TEST(WaitingScans, NoOdometryIsForgottenThatAWaitingScanNeeds) {
  WaitingScans queue;
  OdometryTrack odometry;
  odometry.add(odometry_at(10.0, 0.0));
  EXPECT_EQ(queue.oldest_needed(odometry), Stamp::from_seconds(10.0) - WaitingScans::kLateScan);
  ASSERT_TRUE(queue.add(scan_at(5.0)));
  EXPECT_EQ(queue.oldest_needed(odometry), Stamp::from_seconds(5.0));
}

TEST(SweepMotion, IsWhereTheBaseWasAtTheFirstAndTheLastBeamSeenFromTheMiddle) {
  OdometryTrack odometry;
  EXPECT_FALSE(sweep_motion(odometry, scan_at(1.0)));
  for (int i = 0; i <= 20; ++i) odometry.add(odometry_at(0.1 * i, 0.05 * i));  // 0.5 m/s
  const auto sweep = sweep_motion(odometry, scan_at(1.0));
  ASSERT_TRUE(sweep);
  EXPECT_NEAR(sweep->T_ref_first.x, -0.025, 1e-9);
  EXPECT_NEAR(sweep->T_ref_last.x, 0.025, 1e-9);
  robot::LaserScan instant = scan_at(1.0);
  instant.beam_period = 0.0;
  EXPECT_FALSE(sweep_motion(odometry, instant));
}

}  // namespace
}  // namespace rubble::slam
