#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "tests/support/sim_arena.h"

namespace rubble::sim::test {
namespace {

/// Forwards, backwards, and turning at it: as at any other drop, the body stops where the floor does.
TEST(Rim, TheRobotNeverLeavesTheFloor) {
  const robot::RobotModel model;
  const arenas::Arena arena = flat_floor(-1.0, -1.0, 1.5, 1.0);
  for (const double v : {0.7, 0.2, -0.7}) {
    for (const double heading : {0.0, 0.7, 2.0}) {
      arenas::Arena turned = arena;
      turned.start.phi = heading;
      SimRobot robot(turned, model, exact(), 1);
      run(robot, drive(v), 6.0);
      run(robot, drive(v, 1.0), 6.0);
      for (const StampedPose& at : robot.truth()) {
        ASSERT_TRUE(std::isfinite(arenas::floor_height(turned, {at.pose.x, at.pose.y})))
            << "v " << v << ", heading " << heading << ", " << at.stamp.seconds() << " s";
      }
    }
  }
  SimRobot robot(arena, model, exact(), 1);
  run(robot, drive(0.4), 6.0);
  EXPECT_NEAR(robot.truth().back().pose.x, 1.5 - 0.5 * model.length, 0.02) << "its front is at the rim";
}

/// A floor that goes on is none, whatever its height within the climb.
TEST(Rim, AFloorThatGoesOnIsDrivenOn) {
  arenas::Arena arena = flat_floor(-1.0, -1.0, 1.0, 1.0);
  arena.floor.push_back({rectangle(1.0, -1.0, 4.0, 1.0), 0.05, 0.0, 0.0, "flat"});
  arena.max_corner = {4.0, 1.0};
  SimRobot robot(arena, {}, exact(), 1);
  run(robot, drive(0.4), 6.0);
  EXPECT_GT(robot.truth().back().pose.x, 2.0);
}

}  // namespace
}  // namespace rubble::sim::test
