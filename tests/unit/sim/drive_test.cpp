#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "base/angle.h"
#include "tests/support/sim_arena.h"

namespace rubble::sim::test {
namespace {

using mrpt::math::TPose2D;

const TPose2D& where(const SimRobot& robot) { return robot.truth().back().pose; }

TEST(Drive, ZeroSlipOdometryIsExactOnStraightDrives) {
  SimRobot robot(flat_floor(-10, -10, 10, 10), {}, exact(), 1);
  robot::Odometry last;
  double worst = 0.0;
  run(robot, drive(0.5), 12.0, [&](const robot::Inputs& inputs) {
    for (const auto& odometry : inputs.odometry) {
      const auto truth = pose_at(robot.truth(), odometry.stamp);
      if (!truth) continue;
      worst = std::max(worst, std::abs(odometry.pose.x - truth->x));
      last = odometry;
    }
  });
  run(robot, drive(0.0), 3.0);
  std::cout << "worst error of x over " << where(robot).x << " m: " << worst * 1e3 << " mm\n";
  EXPECT_GT(where(robot).x, 5.0);
  EXPECT_LE(worst, 0.0006);
  EXPECT_EQ(last.pose.y, 0.0);
  EXPECT_EQ(last.pose.phi, 0.0);
  EXPECT_NEAR(where(robot).y, 0.0, 1e-6);
}

TEST(Drive, SkidSteeringWidensTheTrackAboutOneAndAHalfTimes) {
  const robot::RobotModel model;
  for (const double w : {0.3, 0.6, 1.0}) {
    for (const double v : {0.0, 0.2}) {
      SimRobot robot(flat_floor(-10, -10, 10, 10), model, exact(), 1);
      run(robot, drive(v, w), 3.0);
      const double before = where(robot).phi;
      double wheels = 0.0;
      int reports = 0;
      double turned = 0.0;
      double last = before;
      run(robot, drive(v, w), 4.0, [&](const robot::Inputs& inputs) {
        turned += wrap_angle(where(robot).phi - last);
        last = where(robot).phi;
        for (const auto& o : inputs.odometry) {
          wheels += o.w * model.effective_track;
          ++reports;
        }
      });
      const double differential = wheels / reports;
      const double effective = differential / (turned / 4.0);
      std::cout << "v " << v << " w " << w << ": effective track " << effective << " m = " << effective / model.track
                << " x geometric\n";
      EXPECT_NEAR(effective / model.track, 1.48, 0.05);
    }
  }
}

TEST(Drive, TheRobotStallsAgainstAWall) {
  arenas::Arena arena = flat_floor(-3, -3, 3, 3);
  add_wall(arena, 1.0, -3, 1.02, 3);
  SimRobot robot(arena, {}, exact(), 1);
  bool stalled = false;
  double reckoned = 0.0;
  run(robot, drive(0.3), 6.0, [&](const robot::Inputs& inputs) {
    for (const auto& o : inputs.odometry) {
      stalled = o.stalled;
      reckoned = o.pose.x;
    }
  });
  const robot::RobotModel model;
  std::cout << "front at " << where(robot).x + 0.5 * model.length << " m, reckoned " << reckoned << '\n';
  EXPECT_TRUE(stalled);
  EXPECT_NEAR(where(robot).x + 0.5 * model.length, 1.0, 0.01);
  EXPECT_NEAR(reckoned, where(robot).x, 0.02);  // the wheels are blocked, too
}

TEST(Drive, ARampIsClimbedAndReportedAsPitch) {
  arenas::Arena arena = flat_floor(-2, -2, 1, 2);
  add_ramp(arena, 1, -2, 5, 2, deg_to_rad(10.0));
  SimRobot robot(arena, {}, exact(), 1);
  double x = 0.0;
  run(robot, drive(0.3), 8.0, [&](const robot::Inputs& inputs) {
    for (const auto& a : inputs.accelerations) x = a.x;
  });
  EXPECT_GT(where(robot).x, 1.5);
  EXPECT_NEAR(rad_to_deg(std::asin(x / 9.80665)), 10.0, 0.3);
}

}  // namespace
}  // namespace rubble::sim::test
