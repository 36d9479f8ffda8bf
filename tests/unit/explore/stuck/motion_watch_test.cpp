#include "explore/stuck/motion_watch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angle.h"
#include "explore/motion/pivot.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPose2D;

TEST(MotionWatch, ARobotThatMovesAsToldIsNotStuck) {
  MotionWatch watch;
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(watch.stuck({0.4 * 0.02 * i, 0.0, 0.0}, {0.4, 0.0}, false, 0.02));
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(watch.stuck({8.0, 0.0, 1.0 * 0.02 * i}, {0.0, 1.0}, false, 0.02));
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(watch.stuck({8.0, 0.0, 20.0}, {0.0, 0.0}, false, 0.02)) << "it may stand";
}

TEST(MotionWatch, SpinningWheelsAreFoundOutWithinASecondAndAHalf) {
  MotionWatch watch;
  int ticks = 0;
  while (!watch.stuck({1.0 + 0.0002 * (ticks % 3), 0.0, 0.0}, {0.4, 0.0}, false, 0.02)) ASSERT_LT(++ticks, 75);
  MotionWatch turning;
  ticks = 0;
  while (!turning.stuck({1.0, 0.0, 0.0}, {0.0, 1.0}, false, 0.02)) ASSERT_LT(++ticks, 75);
}

TEST(MotionWatch, TheWayCommandedCountsOnlyOnceTheWheelsGoThatWay) {
  MotionWatch watch;
  double v = -0.2, x = 0.0;  // it backed off and is told to drive on
  for (int i = 0; i < 200; ++i) {
    v = std::min(0.4, v + 0.3 * 0.02);
    x += v * 0.02;
    ASSERT_FALSE(watch.stuck({x, 0.0, 0.0}, {0.4, 0.0}, false, 0.02, robot::Drive{v, 0.0})) << i;
  }
}

/// Slow bends to and fro add up to many turns commanded; a robot that gets on meanwhile is not held.
TEST(MotionWatch, ARobotThatCreepsAndWigglesIsNotStuck) {
  MotionWatch watch;
  for (int i = 0; i < 2000; ++i) {
    const double w = i % 40 < 20 ? 0.2 : -0.2;
    ASSERT_FALSE(watch.stuck({0.1 * 0.02 * i, 0.0, 0.0}, {0.1, w}, false, 0.02)) << i;
  }
}

/// Between walls that look the same all along a mapper believes wheels that spin before a step; but not that they turn.
TEST(MotionWatch, WheelsThatSteerInVainAreFoundOutWhereverThePoseGoes) {
  for (const double slip : {0.0, 0.5, 0.8, 1.0}) {
    MotionWatch watch;
    double x = 0.0, phi = 0.0, t = 0.0;
    bool stuck = false;
    for (; !stuck && t < 20.0; t += 0.02) {
      x += 0.2 * 0.02;
      phi += (1.0 - slip) * -0.45 * 0.02;
      stuck = watch.stuck({x, 0.0, phi}, {0.2, -0.45}, false, 0.02, robot::Drive{0.2, -0.45});
    }
    EXPECT_EQ(stuck, slip == 1.0) << "slip " << slip << ", after " << t << " s";
    EXPECT_EQ(watch.steers_in_vain(), slip == 1.0);
    if (stuck) {
      EXPECT_LT(t, 2.5);
    }
  }
}

/// The same on the spot: as it backs out of its turn its pose slides along the bare walls, and its heading stays.
TEST(MotionWatch, WheelsThatTurnOnTheSpotInVainAreFoundOutWhereverThePoseGoes) {
  for (const double share : {0.0, 0.3}) {
    SCOPED_TRACE(testing::Message() << "it turns by " << share << " of what its wheels do");
    MotionWatch watch;
    const robot::Drive told{-0.085, 0.45};
    bool stuck = false;
    double t = 0.0;
    for (; !stuck && t < 20.0; t += 0.02)
      stuck = watch.stuck({told.v * t, 0.0, share * told.w * t}, told, false, 0.02, told);
    EXPECT_EQ(stuck, share == 0.0);
    if (stuck) {
      EXPECT_LT(t, 3.0);
    }
  }
}

/// Told to drive off a wall as it turns, a robot that hangs on a step rolls its wheels and does neither.
TEST(MotionWatch, WheelsThatRollInVainInATurnOnTheSpotAreFoundOut) {
  for (const double v : {-0.06, 0.1}) {
    MotionWatch held;
    double t = 0.0;
    while (!held.stuck({4.87, -1.87 + 0.005 * std::sin(t), 1.55}, {std::copysign(0.12, v), -0.2}, false, 0.02,
                       robot::Drive{v, 0.0}))
      ASSERT_LT(t += 0.02, 6.0) << v;
    MotionWatch turns;
    for (int i = 0; i < 1000; ++i)
      ASSERT_FALSE(turns.stuck({0.0, 0.05 * std::sin(0.04 * i), -0.2 * 0.02 * i}, {std::copysign(0.12, v), -0.2}, false,
                               0.02, robot::Drive{v, -0.2}))
          << i;
    MotionWatch leaves;
    for (int i = 0; i < 1000; ++i)
      ASSERT_FALSE(leaves.stuck({0.8 * v * 0.02 * i, 0.0, 0.0}, {std::copysign(0.12, v), -0.2}, false, 0.02,
                                robot::Drive{v, 0.0}))
          << i;
  }
}

/// The turns that a robot is kept on its spot in are judged as such.
TEST(MotionWatch, WhatKeepsARobotOnItsSpotIsSlowerThanADrive) {
  EXPECT_TRUE(MotionWatch().on_the_spot({Pivot::kMostSpeed, 0.2}));
}

/// Along bare walls a mapper slides and finds its place again, by as much as the robot went meanwhile.
TEST(MotionWatch, ACorrectedPoseIsNoRobotThatStands) {
  MotionWatch watch;
  for (int i = 0; i < 2000; ++i) {
    const double slid = 0.15 * (i % 20) / 19.0;
    ASSERT_FALSE(watch.stuck({0.4 * 0.02 * i + slid, 0.0, 0.0}, {0.4, 0.0}, false, 0.02)) << i;
  }
}

/// A base that does not obey for a while: wheels that stand without a stall push against nothing.
TEST(MotionWatch, WheelsThatStandWithoutAStallAreNoObstacleForAWhile) {
  for (const robot::Drive& told : {robot::Drive{0.4, 0.0}, robot::Drive{0.0, 1.0}}) {
    const auto found_after = [&](bool stalls) {
      MotionWatch watch;
      double t = 0.0;
      while (!watch.stuck({1.0, 0.0, 0.0}, told, stalls, 0.02, robot::Drive{}) && t < 30.0) t += 0.02;
      return t;
    };
    EXPECT_LT(found_after(true), 0.5);
    EXPECT_GT(found_after(false), 7.0);
    EXPECT_LT(found_after(false), 12.0) << "not every base tells of stalls";
  }
}

/// A corner hangs on a step: the robot creeps on and is turned about it, whatever its wheels do.
TEST(MotionWatch, ARobotThatIsTurnedAsideIsHeldAndOneThatSlipsOnARampIsNot) {
  MotionWatch aside, ramp;
  int ticks = 0;
  const auto drive = [&](MotionWatch& watch, double rate) {
    const double t = 0.02 * ticks;
    return watch.stuck({0.08 * t, 0.0, rate * t}, {0.2, 0.3}, false, 0.02, robot::Drive{0.2, 0.3});
  };
  while (!drive(aside, -0.3)) ASSERT_LT(++ticks, 75) << "one and a half seconds";
  for (ticks = 0; ticks < 500; ++ticks) ASSERT_FALSE(drive(ramp, 0.1)) << "less than the wheels turn it";
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

}  // namespace
}  // namespace rubble::explore
