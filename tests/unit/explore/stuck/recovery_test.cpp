#include "explore/stuck/recovery.h"

#include <gtest/gtest.h>

#include "base/angle.h"
#include "base/planar.h"
#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPose2D;

/// A robot in the middle of an empty room that gets free, or is held in whatever it tries.
struct Freed {
  static constexpr double kTickTime = 0.02;  // [s]

  robot::RobotModel model;
  Recovery recovery{model, deg_to_rad(60.0)};
  StuckWatch watch{TiltWatchConfig{}};
  Traversable floor = test::measured(test::room(10.0, 10.0));
  Trail trail;
  TPose2D pose{5.0, 5.0, 0.0};
  Stamp now = Stamp::from_seconds(1.0);

  bool begin() { return recovery.begin(Escape::Met::Forwards, pose, now); }
  Recovery::Result run(bool held) {
    for (double t = 0.0; t < 300.0; t += kTickTime) {
      recovery.moved(now, pose);
      const auto result = recovery.step(pose, recovery.drive(), watch, kTickTime, now, trail, floor);
      if (result != Recovery::Result::UnderWay) return result;
      const robot::Drive& drive = recovery.drive();
      if (!held) pose = pose + TPose2D{drive.v * kTickTime, 0.0, drive.w * kTickTime};
      now = now + kTickTime;
    }
    return Recovery::Result::UnderWay;
  }
};

TEST(Recovery, BacksOffUntilItIsFree) {
  Freed robot;
  robot.begin();
  EXPECT_EQ(robot.run(false), Recovery::Result::Free);
  EXPECT_NEAR(robot.pose.x, 4.5, 0.03);
  EXPECT_EQ(robot.recovery.times(), 1);
}

TEST(Recovery, KnowsThePlaceThatHeldItBefore) {
  Freed robot;
  EXPECT_FALSE(robot.begin());
  robot.pose.x += 0.4;
  EXPECT_TRUE(robot.begin());
  robot.pose.x += 0.6;
  EXPECT_FALSE(robot.begin()) << "elsewhere";
  robot.pose.x -= 1.0;
  EXPECT_FALSE(robot.begin()) << "the last place alone counts";
  EXPECT_EQ(robot.recovery.times(), 4);
}

TEST(Recovery, TenFailuresInARowAreTheEnd) {
  Freed robot;
  for (int i = 0; i < 9; ++i) {
    robot.begin();
    ASSERT_EQ(robot.run(true), Recovery::Result::Failed) << i;
  }
  robot.begin();
  EXPECT_EQ(robot.run(true), Recovery::Result::Stuck);
}

TEST(Recovery, GettingFreeBeginsTheCountAnew) {
  Freed robot;
  for (int round = 0; round < 2; ++round) {
    for (int i = 0; i < 9; ++i) {
      robot.begin();
      ASSERT_EQ(robot.run(true), Recovery::Result::Failed) << round << ' ' << i;
    }
    robot.begin();
    ASSERT_EQ(robot.run(false), Recovery::Result::Free);
    robot.pose = {5.0, 5.0, 0.0};
  }
}

/// A wall of the map stands right behind it: there is no backing off, so it looks for another way.
TEST(Recovery, DoesNotBackIntoAWallOfTheMap) {
  Freed robot;
  OccupancyGrid cells = test::room(10.0, 10.0);
  test::fill(cells, 4.4, 2.0, 4.5, 8.0, Occupancy::Occupied);
  robot.floor = test::measured(std::move(cells));
  robot.begin();
  EXPECT_EQ(robot.run(false), Recovery::Result::Free);
  EXPECT_GT(robot.pose.x, 4.7);
}

}  // namespace
}  // namespace rubble::explore
