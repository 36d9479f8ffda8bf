#include "explore/motion/path_watch.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/planted_mapper.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

Stamp instant(double s) { return Stamp::from_seconds(s); }

/// A robot at the origin whose path leads 4 m straight ahead, with room to both sides.
struct StraightAhead {
  robot::RobotModel model;
  PathFollower follower{model, FollowerConfig{}};
  PathWatch watch{model};

  StraightAhead() {
    std::vector<PathPoint> path;
    for (double x = 0.0; x <= 4.0; x += 0.05) path.push_back({{x, 0.0}, 1.0});
    follower.set_path(path);
  }
  bool check(const std::vector<TPoint2D>& hits, double now) {
    return watch.check(follower, hits, TPose2D{}, 0.4, 0.4, instant(now));
  }
};

const std::vector<TPoint2D> kBall = {{0.6, 0.0}, {0.6, 0.05}, {0.6, -0.05}, {0.6, 0.1}};

TEST(PathWatch, ChecksFiveTimesASecond) {
  StraightAhead robot;
  int checks = 0;
  for (double t = 0.0; t < 9.99; t += 0.02) checks += robot.watch.due(instant(t)) ? 1 : 0;
  EXPECT_EQ(checks, 50);
}

TEST(PathWatch, WaitsForAnotherPathWhereSomethingNewStands) {
  StraightAhead robot;
  EXPECT_FALSE(robot.check({{0.6, 1.0}, {0.6, 1.1}, {0.6, 1.2}}, 1.0)) << "beside the way";
  EXPECT_FALSE(robot.check({kBall[0]}, 1.2)) << "one hit may be noise";
  EXPECT_FALSE(robot.check({{3.0, 0.0}, {3.0, 0.1}, {3.0, -0.1}}, 1.4)) << "far ahead";
  EXPECT_FALSE(robot.watch.waits(instant(1.4)));
  EXPECT_TRUE(robot.check(kBall, 1.6));
  EXPECT_TRUE(robot.watch.waits(instant(1.6)));
  robot.watch.unblock();
  EXPECT_FALSE(robot.watch.waits(instant(1.6)));
}

TEST(PathWatch, RemembersForTenSecondsWhatItFoundNearby) {
  StraightAhead robot;
  std::vector<TPoint2D> hits = kBall;
  hits.push_back({0.0, 3.0});
  ASSERT_TRUE(robot.check(hits, 1.0));
  EXPECT_EQ(robot.watch.obstacles(instant(10.9)).size(), kBall.size()) << "what is far away is left to the map";
  EXPECT_TRUE(robot.watch.obstacles(instant(11.0)).empty());
}

/// The way round is longer than ten seconds: what it leads round is remembered as long, found anew or not, and moves
/// with the map.
TEST(PathWatch, RemembersForLongerWhatTheRobotDrivesRound) {
  StraightAhead robot;
  ASSERT_TRUE(robot.check(kBall, 1.0));
  robot.watch.remember(100.0, instant(1.0));
  EXPECT_FALSE(robot.watch.obstacles(instant(11.0)).empty());
  robot.watch.unblock();
  ASSERT_TRUE(robot.check({{0.5, 0.2}, {0.5, 0.15}, {0.5, 0.1}}, 20.0));
  EXPECT_EQ(robot.watch.obstacles(instant(20.0)).size(), kBall.size() + 3) << "another one does not replace it";
  test::PlantedMapper mapper;
  mapper.plant(instant(1.0), {0.0, 2.0, 0.0});
  robot.watch.follow(mapper);
  const std::vector<TPoint2D> left = robot.watch.obstacles(instant(100.9));
  ASSERT_EQ(left.size(), kBall.size());
  EXPECT_NEAR(left.front().y, kBall.front().y + 2.0, 1e-9);
  EXPECT_TRUE(robot.watch.obstacles(instant(101.0)).empty());
}

TEST(PathWatch, CreepsAndDoesNotWaitWhereTheMapShowsTheWay) {
  StraightAhead robot;
  robot.watch.creep(instant(1.0));
  EXPECT_FALSE(robot.check(kBall, 1.2));
  EXPECT_FALSE(robot.watch.waits(instant(1.2)));
  const robot::Drive drive = robot.watch.limited({0.4, 0.8}, instant(1.2));
  EXPECT_LT(drive.v, 0.2);
  EXPECT_GT(drive.v, 0.0);
  EXPECT_NEAR(drive.w / drive.v, 2.0, 1e-9) << "the same curve, more slowly";
  EXPECT_EQ(robot.watch.limited({0.0, 1.0}, instant(1.2)).w, 1.0) << "turns are no faster for it, nor slower";
  EXPECT_EQ(robot.watch.limited({0.4, 0.8}, instant(4.1)).v, 0.4) << "three seconds later";
}

TEST(PathWatch, PushingIsSlowButWaitsForWhatElseStandsThere) {
  StraightAhead robot;
  robot.watch.slow_down(instant(1.0));
  EXPECT_LT(robot.watch.limited({0.4, 0.0}, instant(1.5)).v, 0.2);
  EXPECT_TRUE(robot.check(kBall, 1.5));
  EXPECT_TRUE(robot.watch.waits(instant(1.5)));
  EXPECT_EQ(robot.watch.limited({0.4, 0.0}, instant(2.1)).v, 0.4);
}

}  // namespace
}  // namespace rubble::explore
