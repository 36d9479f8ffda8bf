#include "explore/plan/path_follower.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/angle.h"
#include "base/rng.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::Drive;
using robot::RobotModel;

std::vector<PathPoint> straight(double length, double clearance = 0.6) {
  std::vector<PathPoint> path;
  for (int i = 0; i * 0.05 <= length + 1e-9; ++i) path.push_back({{i * 0.05, 0.0}, clearance});
  return path;
}

/// A quarter circle to the left between two straights.
std::vector<PathPoint> bend(double radius) {
  std::vector<PathPoint> path = straight(1.0);
  for (double a = 0.05 / radius; a < 0.5 * kPi; a += 0.05 / radius)
    path.push_back({{1.0 + radius * std::sin(a), radius * (1.0 - std::cos(a))}, 0.6});
  for (int i = 0; i <= 20; ++i) path.push_back({{1.0 + radius, radius + i * 0.05}, 0.6});
  return path;
}

/// A unicycle with the model's acceleration limits.
struct Unicycle {
  TPose2D pose;
  Drive drive;
  void step(const Drive& command, const RobotModel& model, double dt = 0.02) {
    const double dv = model.max_accel * dt;
    const double dw = model.max_turn_accel * dt;
    drive.v += std::clamp(command.v - drive.v, -dv, dv);
    drive.w += std::clamp(command.w - drive.w, -dw, dw);
    pose = {pose.x + drive.v * dt * std::cos(pose.phi), pose.y + drive.v * dt * std::sin(pose.phi),
            wrap_angle(pose.phi + drive.w * dt)};
  }
};

TEST(PathFollower, WithoutAPathItStands) {
  PathFollower follower({}, {});
  const Drive drive = follower.drive({1.0, 2.0, 0.3});
  EXPECT_EQ(drive.v, 0.0);
  EXPECT_EQ(drive.w, 0.0);
  EXPECT_TRUE(follower.arrived());
}

TEST(PathFollower, DrivesStraightAheadAtCruiseSpeedAndStopsAtTheEnd) {
  const RobotModel model;
  PathFollower follower(model, {});
  follower.set_path(straight(3.0));
  Unicycle robot;
  double fastest = 0.0;
  for (int i = 0; i < 1500 && !follower.arrived(); ++i) {
    robot.step(follower.drive(robot.pose), model);
    fastest = std::max(fastest, robot.drive.v);
    ASSERT_NEAR(robot.pose.y, 0.0, 1e-9);
  }
  for (int i = 0; i < 100; ++i) robot.step(follower.drive(robot.pose), model);
  EXPECT_TRUE(follower.arrived());
  EXPECT_NEAR(fastest, FollowerConfig().cruise_speed, 0.01);
  EXPECT_NEAR(robot.pose.x, 3.0, 0.12);
  EXPECT_EQ(robot.drive.v, 0.0);
}

TEST(PathFollower, IsFasterOnlyWhereTheRobotWasBefore) {
  const RobotModel model;
  PathFollower follower(model, {});
  std::vector<PathPoint> path = straight(6.0);
  for (PathPoint& point : path)
    if (point.p_map.x > 1.0 && point.p_map.x < 4.0) point.ground = Ground::Passed;
  follower.set_path(path);
  Unicycle robot;
  double fastest = 0.0;
  for (int i = 0; i < 2500 && !follower.arrived(); ++i) {
    robot.step(follower.drive(robot.pose), model);
    fastest = std::max(fastest, robot.drive.v);
    const bool new_ground = robot.pose.x < 0.95 || robot.pose.x > 4.05;
    ASSERT_LE(robot.drive.v, (new_ground ? FollowerConfig().cruise_speed : FollowerConfig().passed_speed) + 0.01)
        << robot.pose.x;
  }
  EXPECT_NEAR(fastest, FollowerConfig().passed_speed, 0.01);
}

/// Faster than what slopes and rough ground allow.
FollowerConfig hasty() {
  FollowerConfig config;
  config.cruise_speed = 0.6;
  config.passed_speed = 0.7;
  config.slope_speed = 0.4;
  config.turn_speed = deg_to_rad(85.0);
  return config;
}

/// Drives the whole path; the fastest between 2 and 4 m, and elsewhere.
std::pair<double, double> fastest_on(const std::vector<PathPoint>& path) {
  const RobotModel model;
  PathFollower follower(model, hasty());
  follower.set_path(path);
  Unicycle robot;
  double there = 0.0, elsewhere = 0.0;
  for (int i = 0; i < 2500 && !follower.arrived(); ++i) {
    robot.step(follower.drive(robot.pose), model);
    double& fastest = robot.pose.x > 2.0 && robot.pose.x < 4.0 ? there : elsewhere;
    fastest = std::max(fastest, robot.drive.v);
  }
  EXPECT_TRUE(follower.arrived());
  return {there, elsewhere};
}

TEST(PathFollower, IsSlowerWhereTheFloorIsSteep) {
  const FollowerConfig config = hasty();
  double last = config.cruise_speed;
  for (const double slope : {2.0, 5.0, 7.0, 9.0, 16.0}) {
    std::vector<PathPoint> path = straight(6.0);
    for (PathPoint& point : path)
      if (point.p_map.x > 1.9 && point.p_map.x < 4.1) point.slope = deg_to_rad(slope);
    const auto [there, elsewhere] = fastest_on(path);
    EXPECT_LE(there, last + 1e-9) << slope;
    EXPECT_NEAR(elsewhere, config.cruise_speed, 0.01) << slope;
    last = there;
  }
  EXPECT_NEAR(last, config.slope_speed, 0.01);
}

TEST(PathFollower, IsSlowerOnRoughGround) {
  std::vector<PathPoint> path = straight(6.0);
  for (PathPoint& point : path)
    if (point.p_map.x > 1.9 && point.p_map.x < 4.1) point.ground = Ground::Rough;
  const auto [there, elsewhere] = fastest_on(path);
  EXPECT_NEAR(there, hasty().rough_speed, 0.01);
  EXPECT_NEAR(elsewhere, hasty().cruise_speed, 0.01);
}

TEST(PathFollower, IsSlowerWhileItLeansWhateverIsKnownOfTheFloor) {
  PathFollower follower({}, hasty());
  follower.set_path(straight(6.0));
  EXPECT_NEAR(follower.drive({0.5, 0.0, 0.0}).v, hasty().cruise_speed, 1e-9);
  EXPECT_NEAR(follower.drive({0.5, 0.0, 0.0}, deg_to_rad(2.0)).v, hasty().cruise_speed, 1e-9);
  EXPECT_NEAR(follower.drive({0.5, 0.0, 0.0}, deg_to_rad(10.0)).v, hasty().slope_speed, 1e-9);
}

TEST(PathFollower, TurnsMoreSlowlyOnASlope) {
  PathFollower follower({}, hasty());
  for (const double heading : {120.0, -120.0}) {
    follower.set_path(straight(3.0));
    const TPose2D pose{0.0, 0.0, deg_to_rad(heading)};
    EXPECT_NEAR(std::abs(follower.drive(pose).w), hasty().turn_speed, 1e-9);
    EXPECT_NEAR(std::abs(follower.drive(pose, deg_to_rad(10.0)).w), hasty().slope_turn, 1e-9);
  }
}

TEST(PathFollower, TurnsOnTheSpotWhileTheHeadingIsFarOff) {
  PathFollower follower({}, {});
  follower.set_path(straight(3.0));
  for (const double heading : {40.0, 90.0, 179.0, -40.0, -120.0}) {
    follower.set_path(straight(3.0));
    const Drive drive = follower.drive({0.0, 0.0, deg_to_rad(heading)});
    EXPECT_EQ(drive.v, 0.0) << heading;
    EXPECT_LT(drive.w * heading, 0.0) << heading;
  }
}

TEST(PathFollower, StartsFromAnyHeadingAndEndsOnThePath) {
  const RobotModel model;
  for (int degrees = -180; degrees < 180; degrees += 15) {
    PathFollower follower(model, {});
    follower.set_path(straight(4.0));
    Unicycle robot;
    robot.pose = {0.0, 0.15, deg_to_rad(degrees)};
    for (int i = 0; i < 2500 && !follower.arrived(); ++i) robot.step(follower.drive(robot.pose), model);
    EXPECT_TRUE(follower.arrived()) << degrees;
    EXPECT_NEAR(robot.pose.y, 0.0, 0.03) << degrees;
  }
}

TEST(PathFollower, NeverAsksForMoreThanTheLimits) {
  RobotModel model;
  model.max_v = 0.3;
  model.max_w = 0.5;
  FollowerConfig config;
  config.cruise_speed = 1.0;
  config.turn_speed = 3.0;
  PathFollower follower(model, config);
  Rng rng(7, "poses");
  for (int i = 0; i < 2000; ++i) {
    follower.set_path(i % 2 == 0 ? bend(0.4) : straight(2.0));
    const double x = rng.uniform(-1.0, 3.0);
    const double y = rng.uniform(-1.0, 2.0);
    const double phi = rng.uniform(-kPi, kPi);
    const Drive drive = follower.drive({x, y, phi});
    ASSERT_GE(drive.v, 0.0);
    ASSERT_LE(drive.v, 0.3 + 1e-12);
    ASSERT_LE(std::abs(drive.w), 0.5 + 1e-12);
  }
}

TEST(PathFollower, TakesBendsWithoutLeavingThePathFar) {
  const RobotModel model;
  for (const double radius : {0.35, 0.5, 0.8}) {
    PathFollower follower(model, {});
    const std::vector<PathPoint> path = bend(radius);
    follower.set_path(path);
    Unicycle robot;
    double worst = 0.0;
    for (int i = 0; i < 2500 && !follower.arrived(); ++i) {
      robot.step(follower.drive(robot.pose), model);
      double off = 1e9;
      for (const PathPoint& p : path)
        off = std::min(off, std::hypot(p.p_map.x - robot.pose.x, p.p_map.y - robot.pose.y));
      worst = std::max(worst, off);
    }
    EXPECT_TRUE(follower.arrived());
    EXPECT_LT(worst, 0.08) << radius;
  }
}

TEST(PathFollower, IsSlowerWhereItIsNarrowAndBrakesBeforeIt) {
  const RobotModel model;
  std::vector<PathPoint> path = straight(4.0);
  for (PathPoint& p : path)
    if (p.p_map.x > 2.0 && p.p_map.x < 2.5) p.clearance = 0.28;
  PathFollower follower(model, {});
  follower.set_path(path);
  Unicycle robot;
  for (int i = 0; i < 2500 && !follower.arrived(); ++i) {
    robot.step(follower.drive(robot.pose), model);
    if (robot.pose.x > 2.05 && robot.pose.x < 2.45) {
      ASSERT_LT(robot.drive.v, 0.20);
    }
  }
  EXPECT_TRUE(follower.arrived());
}

TEST(PathFollower, TurningOnTheSpotSlowsDownInTime) {
  const RobotModel model;
  for (const double angle : {0.3, 1.0, 2.0, -2.5}) {
    Unicycle robot;
    double left = angle;
    double overshoot = 0.0;
    for (int i = 0; i < 1000; ++i) {
      left = angle - robot.pose.phi;
      const bool done = left * angle <= 0.0 || std::abs(left) < 0.05;
      robot.step(done ? Drive{} : turn_on_the_spot(left, 1.05, 0.6 * model.max_turn_accel), model);
      overshoot = std::max(overshoot, -left * (angle > 0.0 ? 1.0 : -1.0));
    }
    EXPECT_LT(overshoot, 0.08) << angle;
    EXPECT_NEAR(robot.pose.phi, angle, 0.09) << angle;
  }
}

TEST(HitsOnPath, CountsWhatStandsInTheWayAndNothingElse) {
  const RobotModel model;
  const TPose2D pose;
  const auto count = [&](const TPoint2D& hit) { return hits_on_path(straight(3.0), 0, 1.0, 0.28, {hit}, pose, model); };
  EXPECT_EQ(count({0.8, 0.0}), 1);
  EXPECT_EQ(count({0.8, 0.27}), 1);
  EXPECT_EQ(count({0.8, 0.30}), 0) << "beside the path";
  EXPECT_EQ(count({1.6, 0.0}), 0) << "too far ahead to matter yet";
  EXPECT_EQ(count({0.1, 0.1}), 0) << "inside the body: noise";
  EXPECT_EQ(count({-0.27, 0.0}), 0) << "behind";
  EXPECT_EQ(count({-0.1, 0.26}), 0) << "a wall beside the robot that it drives away from";
  EXPECT_EQ(hits_on_path({}, 0, 1.0, 0.28, {{0.5, 0.0}}, pose, model), 0);
}

}  // namespace
}  // namespace rubble::explore
