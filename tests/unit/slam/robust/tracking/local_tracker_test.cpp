#include "slam/robust/tracking/local_tracker.h"

#include <gtest/gtest.h>

#include <cmath>

#include "slam/robust/robust_mapper.h"
#include "tests/support/slam_key_frames.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPose2D;

/// In a corridor without features a scan slides freely: odometry that was doubted for what it said before, and says
/// now what the scan fits as well, holds the robot. Without it each slide would be the next reason to doubt.
TEST(LocalTracker, DoubtedOdometryHoldsTheRobotWhereTheScanMaySlide) {
  robot::RobotModel model;
  const slam_test::World corridor{{{-20.0, 0.7}, {20.0, 0.7}}, {{-20.0, -0.7}, {20.0, -0.7}}};
  const auto places = slam_test::places_along({{0.0, 0.0}, {3.0, 0.0}}, 0.3);
  KeyFrames frames;
  for (std::size_t i = 0; i < places.size(); ++i) slam_test::add_key_frame(frames, corridor, places, 0.0, model);
  LocalTracker tracker(suited_to(model.laser, {}).tracker);
  tracker.redraw(frames, frames.last(), nullptr);
  // On, where the end of the corridor that is seen is new: what slides back over known ground always fits better.
  const TPose2D step(0.15, 0.0, 0.0);
  const Cloud cloud = slam_test::cloud_at(corridor, places.back() + step, model);
  for (const double slide : {-0.1, 0.0, 0.05}) {
    SCOPED_TRACE(slide);
    ExpectedMotion motion;
    motion.T_last_now = step;
    motion.carried = TPose2D(slide, 0.0, 0.0);
    motion.time = 0.1;
    motion.doubt = 1.0;
    motion.told = true;
    const Tracked tracked = tracker.track(frames, cloud, motion, TPose2D(), nullptr);
    EXPECT_TRUE(tracked.found);
    EXPECT_NEAR(tracked.fit.pose.x, step.x, 0.03);
    EXPECT_NEAR(tracked.fit.pose.y, 0.0, 0.01);
  }
}

/// Wheels that spin in a corridor with a door: all walls lie along the way, and only where they end tells that the
/// robot stands.
TEST(LocalTracker, EndsOfWallsHoldARobotWhoseWheelsSpin) {
  robot::RobotModel model;
  const slam_test::World door{{{-20.0, 0.6}, {2.0, 0.6}}, {{3.0, 0.6}, {20.0, 0.6}}, {{-20.0, -0.6}, {20.0, -0.6}}};
  slam_test::World passage = door;  // behind the door
  passage.push_back({{-20.0, 1.8}, {20.0, 1.8}});
  const auto places = slam_test::places_along({{0.0, 0.0}, {1.5, 0.0}}, 0.3);
  for (const slam_test::World& world : {door, passage}) {
    KeyFrames frames;
    for (std::size_t i = 0; i < places.size(); ++i) slam_test::add_key_frame(frames, world, places, 0.0, model);
    LocalTracker tracker(suited_to(model.laser, {}).tracker);
    tracker.redraw(frames, frames.last(), nullptr);
    const Cloud cloud = slam_test::cloud_at(world, places.back(), model);
    ExpectedMotion spinning;
    spinning.T_last_now = TPose2D(0.04, 0.0, 0.0);
    spinning.time = 0.1;
    TPose2D T_frame_now;
    for (int scan = 0; scan < 30; ++scan)
      T_frame_now = tracker.track(frames, cloud, spinning, T_frame_now, nullptr).fit.pose;
    EXPECT_LT(std::abs(T_frame_now.x), 0.08) << "odometry says 1.2 m";
    EXPECT_NEAR(T_frame_now.y, 0.0, 0.01);
  }
}

/// Between bare walls nothing tells a robot that drives from one whose wheels spin; a wall across does.
TEST(LocalTracker, CountsTheWayThatOdometryAloneKnows) {
  robot::RobotModel model;
  const slam_test::World bare{{{-20.0, 0.6}, {20.0, 0.6}}, {{-20.0, -0.6}, {20.0, -0.6}}};
  slam_test::World closed = bare;
  closed.push_back({{3.0, -0.6}, {3.0, 0.6}});
  const auto places = slam_test::places_along({{0.0, 0.0}, {1.5, 0.0}}, 0.3);
  for (const bool wall : {false, true}) {
    KeyFrames frames;
    const slam_test::World& world = wall ? closed : bare;
    for (std::size_t i = 0; i < places.size(); ++i) slam_test::add_key_frame(frames, world, places, 0.0, model);
    LocalTracker tracker(suited_to(model.laser, {}).tracker);
    tracker.redraw(frames, frames.last(), nullptr);
    ExpectedMotion spinning;
    spinning.T_last_now = TPose2D(0.04, 0.0, 0.0);
    spinning.time = 0.1;
    spinning.told = true;
    TPose2D T_frame_now;
    for (int scan = 1; scan <= 20; ++scan) {
      T_frame_now =
          tracker.track(frames, slam_test::cloud_at(world, places.back(), model), spinning, T_frame_now, nullptr)
              .fit.pose;
      EXPECT_NEAR(tracker.blind_way(), wall ? 0.0 : 0.04 * scan, 1e-9);
    }
    EXPECT_NEAR(T_frame_now.x, wall ? 0.0 : 0.8, 0.05);
  }
}

/// A ball that the robot pushes along between two bare walls is all that tells how far it came, and says that it
/// stands.
TEST(LocalTracker, AThingPushedAlongDoesNotHoldTheRobot) {
  robot::RobotModel model;
  for (const double radius : {0.1, 0.22}) {
    const auto pushing = [&](double x) {  // eight sides of a ball before the robot at x
      slam_test::World world{{{-20.0, 0.6}, {20.0, 0.6}}, {{-20.0, -0.6}, {20.0, -0.6}}};
      for (int k = 0; k < 8; ++k) {
        const auto corner = [&](int side) {
          return mrpt::math::TPoint2D(x + 0.4 + radius + radius * std::cos(side * kPi / 4.0),
                                      radius * std::sin(side * kPi / 4.0));
        };
        world.push_back({corner(k), corner(k + 1)});
      }
      return world;
    };
    const auto places = slam_test::places_along({{0.0, 0.0}, {1.5, 0.0}}, 0.3);
    KeyFrames frames;
    for (const TPose2D& place : places) slam_test::add_key_frame(frames, pushing(place.x), places, 0.0, model);
    LocalTracker tracker(suited_to(model.laser, {}).tracker);
    tracker.redraw(frames, frames.last(), nullptr);
    ExpectedMotion driving;
    driving.T_last_now = TPose2D(0.03, 0.0, 0.0);
    driving.time = 0.1;
    driving.told = true;
    TPose2D T_frame_now;
    for (int scan = 1; scan <= 10; ++scan) {
      const double x = places.back().x + 0.03 * scan;
      const Cloud cloud = slam_test::cloud_at(pushing(x), {x, 0.0, 0.0}, model);
      T_frame_now = tracker.track(frames, cloud, driving, T_frame_now, nullptr).fit.pose;
    }
    EXPECT_NEAR(T_frame_now.x, 0.3, 0.02) << radius;
  }
}

/// A corridor with a line across it: a wall, or where the laser's plane cuts a ramp.
slam_test::World corridor_with_line(double x) {
  return {{{-20.0, 0.7}, {20.0, 0.7}}, {{-20.0, -0.7}, {20.0, -0.7}}, {{x, -0.7}, {x, 0.7}}};
}

ExpectedMotion rolled(double distance) {
  ExpectedMotion motion;
  motion.T_last_now = TPose2D(distance, 0.0, 0.0);
  motion.time = 0.1;
  motion.told = true;
  motion.ramps = true;
  return motion;
}

/// Follows scans in a corridor whose line stood at 2 m when the key frames were taken.
class LeapingLine : public ::testing::Test {
 protected:
  LeapingLine() {
    const auto places = slam_test::places_along({{-1.5, 0.0}, {0.0, 0.0}}, 0.3);
    for (std::size_t i = 0; i < places.size(); ++i)
      slam_test::add_key_frame(frames_, corridor_with_line(2.0), places, 0.0, model_);
  }
  /// Where the robot is thought to be after each scan [m]; the wheels say `step` each, the line is seen at `ahead[i]`.
  std::vector<double> follow(double step, const std::vector<double>& ahead, bool hold, double scan_period = 0.1) const {
    TrackerConfig config = suited_to(model_.laser, {}).tracker;
    config.hold_leaps = hold;
    LocalTracker tracker(config);
    tracker.redraw(frames_, frames_.last(), nullptr);
    std::vector<double> at;
    TPose2D T_frame_now;
    for (const double line : ahead) {
      const Cloud cloud = slam_test::cloud_at(corridor_with_line(line), TPose2D(), model_);
      ExpectedMotion motion = rolled(step);
      motion.time = scan_period;
      T_frame_now = tracker.track(frames_, cloud, motion, T_frame_now, nullptr).fit.pose;
      at.push_back(T_frame_now.x);
    }
    return at;
  }
  robot::RobotModel model_;
  KeyFrames frames_;
};

/// The robot pitches before a ramp: the line comes nearer and goes off again, faster than the robot can.
TEST_F(LeapingLine, DoesNotTakeTheRobotAlong) {
  const std::vector<double> pitching{1.85, 1.7, 1.55, 1.75, 1.9};
  const std::vector<double> held = follow(0.0, pitching, true);
  const std::vector<double> taken = follow(0.0, pitching, false);
  double farthest = 0.0;
  for (std::size_t i = 0; i < pitching.size(); ++i) {
    EXPECT_NEAR(held[i], 0.0, 0.03) << "scan " << i;
    farthest = std::max(farthest, std::abs(taken[i]));
  }
  EXPECT_GT(farthest, 0.1) << "without the hold nothing was at stake";
}

/// Whoever was wrong before is put right, as often as five scans on end ask for the same; the odometry holds back a
/// part.
TEST_F(LeapingLine, ThatStaysIsAWall) {
  const std::vector<double> at = follow(0.0, std::vector<double>(12, 1.85), true);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(at[i], 0.0, 0.03) << "scan " << i;
  EXPECT_GT(at[4], 0.08);
  EXPECT_NEAR(at.back(), 0.15, 0.03);
}

/// A scanner of 40 Hz asks as often in an eighth of a second: what tilts needs as long to come back.
TEST_F(LeapingLine, IsHeldAsLongByAFastScanner) {
  const std::vector<double> at = follow(0.0, std::vector<double>(24, 1.85), true, 0.025);
  for (std::size_t i = 0; i < 17; ++i) EXPECT_NEAR(at[i], 0.0, 0.03) << "scan " << i;
  EXPECT_GT(at[18], 0.08);
}

/// Wheels that spin before a wall: between not at all and as they say the robot may have moved, so nothing is held.
TEST_F(LeapingLine, StandsBeforeSpinningWheels) {
  const std::vector<double> at = follow(0.04, std::vector<double>(10, 2.0), true);
  for (const double x : at) EXPECT_NEAR(x, 0.0, 0.03);
}

/// A robot that somebody lifts in a room: most of what it sees says so, which a level scan is believed at once.
TEST(LocalTracker, BelievesALeapThatMostOfTheScanAsksFor) {
  robot::RobotModel model;
  const slam_test::World room{
      {{-1.5, -1.5}, {1.5, -1.5}}, {{1.5, -1.5}, {1.5, 1.5}}, {{1.5, 1.5}, {-1.5, 1.5}}, {{-1.5, 1.5}, {-1.5, -1.5}}};
  const auto places = slam_test::places_along({{-0.3, 0.0}, {0.0, 0.0}}, 0.3);
  KeyFrames frames;
  for (std::size_t i = 0; i < places.size(); ++i) slam_test::add_key_frame(frames, room, places, 0.0, model);
  LocalTracker tracker(suited_to(model.laser, {}).tracker);
  tracker.redraw(frames, frames.last(), nullptr);
  const Cloud cloud = slam_test::cloud_at(room, TPose2D(0.12, 0.0, 0.0), model);
  ExpectedMotion motion = rolled(0.0);
  EXPECT_NEAR(tracker.track(frames, cloud, motion, TPose2D(), nullptr).fit.pose.x, 0.12, 0.02);
  motion.level = false;
  EXPECT_NEAR(tracker.track(frames, cloud, motion, TPose2D(), nullptr).fit.pose.x, 0.0, 0.03);
}

/// Loose paper under the wheels of one side: tilted on a ramp the body turns by a fourth of what they say, and slid
/// farther than a robot can. Where the robot is may be held; how it is turned is what the scan says, or each scan held
/// so would be farther off than the one before.
TEST(LocalTracker, TakesTheHeadingFromAScanWhoseLeapItHolds) {
  robot::RobotModel model;
  const slam_test::World room{
      {{-2.5, -2.5}, {2.5, -2.5}}, {{2.5, -2.5}, {2.5, 2.5}}, {{2.5, 2.5}, {-2.5, 2.5}}, {{-2.5, 2.5}, {-2.5, -2.5}}};
  const auto places = slam_test::places_along({{-0.3, 0.0}, {0.0, 0.0}}, 0.3);
  KeyFrames frames;
  for (std::size_t i = 0; i < places.size(); ++i) slam_test::add_key_frame(frames, room, places, 0.0, model);
  for (const double sideways : {-0.08, 0.08}) {
    SCOPED_TRACE(sideways);
    LocalTracker tracker(suited_to(model.laser, {}).tracker);
    tracker.redraw(frames, frames.last(), nullptr);
    ExpectedMotion motion = rolled(0.0);
    motion.T_last_now.phi = deg_to_rad(2.6);
    motion.level = false;
    TPose2D T_frame_now;
    for (int scan = 1; scan <= 4; ++scan) {
      const double turned = deg_to_rad(0.65) * scan;
      const Cloud cloud = slam_test::cloud_at(room, TPose2D(0.0, sideways, turned), model);
      const Tracked tracked = tracker.track(frames, cloud, motion, T_frame_now, nullptr);
      T_frame_now = tracked.fit.pose;
      EXPECT_TRUE(tracked.held) << "nothing was at stake";
      EXPECT_NEAR(T_frame_now.phi, turned, deg_to_rad(1.5)) << "scan " << scan;
    }
  }
}

}  // namespace
}  // namespace rubble::slam
