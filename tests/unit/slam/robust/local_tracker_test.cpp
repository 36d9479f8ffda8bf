#include "slam/robust/local_tracker.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace rubble::slam
