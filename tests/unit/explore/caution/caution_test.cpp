#include <gtest/gtest.h>

#include <cmath>

#include "explore/caution/attempts.h"
#include "explore/caution/blacklist.h"
#include "explore/caution/passed_floor.h"
#include "explore/search/pose_doubt.h"
#include "explore/stuck/motion_watch.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPose2D;

TEST(Blacklist, BarsADiscUntilItExpires) {
  Blacklist list;
  list.bar({1.0, 1.0}, 0.5, Stamp::from_seconds(10.0));
  EXPECT_TRUE(list.barred({1.3, 1.3}, Stamp::from_seconds(5.0)));
  EXPECT_FALSE(list.barred({1.5, 1.5}, Stamp::from_seconds(5.0)));
  EXPECT_FALSE(list.barred({1.3, 1.3}, Stamp::from_seconds(10.0)));
  EXPECT_EQ(list.times_barred({1.0, 1.2}), 1) << "it remembers what has expired";
}

TEST(Blacklist, PardonsWhatWouldExpireAndNothingElse) {
  Blacklist list;
  const Stamp now = Stamp::from_seconds(5.0);
  EXPECT_FALSE(list.pardon(now));
  list.bar({1.0, 1.0}, 0.5, Stamp::from_seconds(10.0));
  list.bar_for_good({5.0, 5.0}, 0.5);
  EXPECT_TRUE(list.pardon(now));
  EXPECT_FALSE(list.barred({1.0, 1.0}, now));
  EXPECT_TRUE(list.barred({5.0, 5.0}, now));
  EXPECT_FALSE(list.pardon(now)) << "nothing is left to pardon";
}

TEST(Blacklist, PardonOfAllEndsBarsForGoodAsWell) {
  const Stamp now = Stamp::from_seconds(10.0);
  Blacklist list;
  list.bar_for_good({1.0, 0.0}, 0.5);
  EXPECT_FALSE(list.pardon(now));
  EXPECT_TRUE(list.barred({1.0, 0.0}, now));
  EXPECT_TRUE(list.pardon_all(now));
  EXPECT_FALSE(list.barred({1.0, 0.0}, now));
  EXPECT_FALSE(list.pardon_all(now)) << "nothing is left to pardon";
}

TEST(MotionWatch, ARobotThatMovesAsToldIsNotStuck) {
  MotionWatch watch;
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(watch.stuck({0.4 * 0.02 * i, 0.0, 0.0}, {0.4, 0.0}, false, 0.02));
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(watch.stuck({8.0, 0.0, 1.0 * 0.02 * i}, {0.0, 1.0}, false, 0.02));
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(watch.stuck({8.0, 0.0, 20.0}, {0.0, 0.0}, false, 0.02)) << "it may stand";
}

TEST(MotionWatch, SpinningWheelsAreFoundOutWithinTwoSeconds) {
  MotionWatch watch;
  int ticks = 0;
  while (!watch.stuck({1.0 + 0.0002 * (ticks % 3), 0.0, 0.0}, {0.4, 0.0}, false, 0.02)) ASSERT_LT(++ticks, 100);
  MotionWatch turning;
  ticks = 0;
  while (!turning.stuck({1.0, 0.0, 0.0}, {0.0, 1.0}, false, 0.02)) ASSERT_LT(++ticks, 100);
}

/// Fast wheels spin before a step: each tick of odometry carries the pose on, each scan puts it back.
TEST(MotionWatch, APoseThatTremblesInItsPlaceIsFoundOut) {
  for (const double speed : {0.4, 0.55, 0.7}) {
    MotionWatch watch;
    int ticks = 0;
    while (!watch.stuck({1.0 + speed * 0.02 * (ticks % 6), 0.0, 0.0}, {speed, 0.0}, false, 0.02))
      ASSERT_LT(++ticks, 150) << "three seconds, at " << speed << " m/s";
  }
}

/// A corner hangs on something: the robot turns away, slips back, and turns again.
TEST(MotionWatch, RockingToAndFroIsFoundOutAndATurnOnTheSpotIsNone) {
  MotionWatch rocking;
  double heading = 0.0;
  int ticks = 0;
  for (double rate = 1.0; !rocking.stuck({1.0 + 0.1 * heading, 2.0, heading}, {0.0, rate}, false, 0.02); ++ticks) {
    heading += rate * 0.02;
    if (std::abs(heading) > 0.3) rate = heading > 0.0 ? -1.0 : 1.0;
    ASSERT_LT(ticks, 500) << "ten seconds";
  }
  EXPECT_TRUE(rocking.rocking());
  MotionWatch turning, looking;
  for (double turned = 0.0; turned < kPi; turned += 0.02)
    EXPECT_FALSE(turning.stuck({1.0, 2.0, turned}, {0.0, 1.0}, false, 0.02));
  for (double turned = 0.0; turned < 4.0 * kPi; turned += 0.02) {
    looking.turns_on_purpose();
    EXPECT_FALSE(looking.stuck({1.0, 2.0, turned}, {0.0, 1.0}, false, 0.02));
  }
}

TEST(MotionWatch, AStallCountsWhenItLasts) {
  MotionWatch watch;
  const TPose2D pose;
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(watch.stuck(pose, {}, true, 0.02));
  EXPECT_FALSE(watch.stuck(pose, {}, false, 0.02)) << "a short stall is forgotten";
  bool stuck = false;
  for (int i = 0; i < 20; ++i) stuck = watch.stuck(pose, {}, true, 0.02);
  EXPECT_TRUE(stuck);
  watch.reset();
  EXPECT_FALSE(watch.stuck(pose, {}, true, 0.02));
}

PoseCovariance covariance_of(double sigma, double sigma_heading) {
  PoseCovariance covariance;
  covariance(0, 0) = covariance(1, 1) = sigma * sigma;
  covariance(2, 2) = sigma_heading * sigma_heading;
  return covariance;
}

/// The covariance that a heading known to `sigma` at the origin leaves at a place so far away.
PoseCovariance swung(double sigma, const TPose2D& there) {
  PoseCovariance covariance;
  covariance(0, 0) = sigma * sigma * there.y * there.y;
  covariance(1, 1) = sigma * sigma * there.x * there.x;
  covariance(0, 1) = covariance(1, 0) = -sigma * sigma * there.x * there.y;
  covariance(0, 2) = covariance(2, 0) = -sigma * sigma * there.y;
  covariance(1, 2) = covariance(2, 1) = sigma * sigma * there.x;
  covariance(2, 2) = sigma * sigma;
  return covariance;
}

TEST(PoseDoubt, AMapThatStandsAskewAsAWholeIsNoDoubt) {
  PoseDoubt doubt;
  doubt.update({}, swung(deg_to_rad(4.0), {}), 0.02);
  for (double way = 0.0; way < 20.0; way += 0.4 * 0.02) {
    const TPose2D pose{way, 0.3 * way, 0.0};
    doubt.update(pose, swung(deg_to_rad(4.0), pose), 0.02);
    ASSERT_FALSE(doubt.unsure()) << way << " m away, where the position alone is off by " << 0.07 * way << " m";
  }
}

TEST(PoseDoubt, WhatEveryWayCostsIsNoDoubtAndAJumpIsOne) {
  PoseDoubt doubt;
  double variance = 0.0;
  for (int i = 0; i < 20000; ++i) {  // 400 s: to 0.6 m
    variance += 0.36 / 20000;
    doubt.update({0.001 * i, 0.0, 0.0}, covariance_of(std::sqrt(0.5 * variance), 0.0), 0.02);
    ASSERT_FALSE(doubt.unsure());
  }
  const TPose2D lost{20.0, 0.0, 0.0};
  for (int i = 0; i < 1000; ++i) {
    doubt.update(lost, covariance_of(0.9, 0.0), 0.02);
    ASSERT_TRUE(doubt.unsure()) << "20 s";
  }
  doubt.update(lost, covariance_of(0.3, 0.0), 0.02);
  EXPECT_FALSE(doubt.unsure());
  doubt.update(lost, covariance_of(0.31, 0.0), 0.02);
  EXPECT_FALSE(doubt.unsure());
}

TEST(PoseDoubt, AMapperThatDoesNotEstimateItIsNeverDoubted) {
  PoseDoubt doubt;
  for (int i = 0; i < 1000; ++i) {
    doubt.update({0.01 * i, 0.0, 0.0}, {}, 0.02);
    ASSERT_FALSE(doubt.unsure());
  }
}

TEST(PassedFloor, HoldsWhatIsBesideTheWayAndNothingElse) {
  PassedFloor floor;
  EXPECT_FALSE(floor.holds({0.0, 0.0}));
  for (double x = -1.0; x < 1.0; x += 0.15) floor.add({x, -0.02});
  for (double x = -0.95; x < 0.9; x += 0.05) {
    EXPECT_TRUE(floor.holds({x, 0.0}));
    EXPECT_TRUE(floor.holds({x, 0.12}));
    EXPECT_FALSE(floor.holds({x, 0.35}));
    EXPECT_FALSE(floor.holds({x, -0.35}));
  }
  floor.clear();
  EXPECT_FALSE(floor.holds({0.0, 0.0}));
}

TEST(Attempts, ATargetGetsTimeByItsCostAndIsThenOverdrawn) {
  Attempts attempts;
  double spent = 0.0;
  while (!attempts.overdrawn({5.0, 5.0}, 10.0, 0.1)) ASSERT_LT(spent += 0.1, 1000.0);
  EXPECT_GT(spent, 10.0 / 0.4) << "more than the drive takes";
  EXPECT_FALSE(attempts.overdrawn({5.0, 5.0}, 10.0, 0.1)) << "a new account";
}

TEST(Attempts, GoingToAndFroBetweenTargetsDoesNotRenewTheirTime) {
  Attempts attempts;
  double spent = 0.0;
  bool overdrawn = false;
  for (int i = 0; !overdrawn; ++i) {
    overdrawn =
        attempts.overdrawn(i % 2 == 0 ? mrpt::math::TPoint2D{0.0, 0.0} : mrpt::math::TPoint2D{9.0, 0.0}, 2.0, 0.5);
    ASSERT_LT(spent += 0.5, 200.0);
  }
}

}  // namespace
}  // namespace rubble::explore
