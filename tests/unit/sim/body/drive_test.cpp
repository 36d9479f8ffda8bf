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
  EXPECT_NEAR(where(robot).y, 0.0, 1e-3 / 138.0);  // less than an encoder's tick
}

TEST(Drive, SkidSteeringWidensTheTrackAboutOneAndAHalfTimes) {
  const robot::RobotModel model;
  for (const double w : {0.3, 0.6, 1.0}) {
    for (const double v : {0.0, 0.2}) {
      SimRobot robot(flat_floor(-10, -10, 10, 10), model, exact(), 1);
      double turned = 0.0;
      double reckoned = 0.0;
      double last = 0.0;
      double last_reckoned = 0.0;
      run(robot, drive(v, w), 8.0, [&](const robot::Inputs& inputs) {
        if (inputs.odometry.empty()) return;
        turned += wrap_angle(where(robot).phi - last);
        last = where(robot).phi;
        reckoned += wrap_angle(inputs.odometry.back().pose.phi - last_reckoned);
        last_reckoned = inputs.odometry.back().pose.phi;
      });
      const double effective = reckoned * model.effective_track / turned;
      std::cout << "v " << v << " w " << w << ": effective track " << effective << " m = " << effective / model.track
                << " x geometric\n";
      EXPECT_NEAR(effective / model.track, 1.48, 0.01);
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

TEST(Drive, PaperMakesOdometryLongerThanTheTruth) {
  arenas::Arena arena = flat_floor(-2, -2, 8, 2);
  arena.sheets.push_back({rectangle(-2, -2, 8, 2), 0.25});
  SimRobot robot(arena, {}, exact(), 1);
  double reckoned = 0.0;
  run(robot, drive(0.3), 10.0, [&](const robot::Inputs& inputs) {
    for (const auto& o : inputs.odometry) reckoned = o.pose.x;
  });
  const double slip = 1.0 - where(robot).x / reckoned;
  std::cout << "on paper: " << where(robot).x << " m driven, " << reckoned << " m counted, slip " << slip << '\n';
  EXPECT_GT(slip, 0.03);
  EXPECT_LT(slip, 0.2);
}

TEST(Drive, PaperMakesTheRobotTurnLessThanItsEncodersSay) {
  double turned[3];
  for (int i = 0; i < 3; ++i) {
    arenas::Arena arena = flat_floor(-4, -4, 4, 4);
    if (i == 1) arena.sheets.push_back({rectangle(-4, 0, 4, 4), 0.25});  // under half of the robot
    if (i == 2) arena.sheets.push_back({rectangle(-4, -4, 4, 4), 0.25});
    SimRobot robot(arena, {}, exact(), 1);
    double heading = 0.0;
    run(robot, drive(0.0, 0.5), 6.0, [&](const robot::Inputs& inputs) {
      for (const auto& o : inputs.odometry) heading = o.pose.phi;
    });
    turned[i] = where(robot).phi / heading;
    std::cout << "turned " << rad_to_deg(where(robot).phi) << " deg of " << rad_to_deg(heading) << ", aside by "
              << 1e3 * std::hypot(where(robot).x, where(robot).y) << " mm\n";
  }
  EXPECT_LT(turned[1], 0.97 * turned[0]);
  EXPECT_LT(turned[2], 0.97 * turned[0]);
}

TEST(Drive, OnARampOdometryIsLongerThanThePlanByOneOverCosine) {
  const double angle = deg_to_rad(10.0);
  arenas::Arena arena = slope(-5, -2, 20, 2, angle);
  SimRobot robot(arena, {}, exact(), 1);
  double reckoned = 0.0;
  run(robot, drive(0.3), 10.0, [&](const robot::Inputs& inputs) {
    for (const auto& o : inputs.odometry) reckoned = o.pose.x;
  });
  EXPECT_NEAR(reckoned / where(robot).x, 1.0 / std::cos(angle), 0.001);
}

TEST(Drive, AWheelOnPaperSpinsAgainstAWall) {
  arenas::Arena arena = flat_floor(-3, -3, 3, 3);
  arena.sheets.push_back({rectangle(-3, -3, 3, 3), 0.25});
  add_wall(arena, 1.0, -3, 1.02, 3);
  SimRobot robot(arena, {}, exact(), 1);
  double reckoned = 0.0;
  bool stalled = false;
  run(robot, drive(0.3), 8.0, [&](const robot::Inputs& inputs) {
    for (const auto& o : inputs.odometry) {
      reckoned = o.pose.x;
      stalled = stalled || o.stalled;
    }
  });
  EXPECT_LT(where(robot).x, 0.76);
  EXPECT_GT(reckoned, 1.8);  // the wheels turn on
  EXPECT_FALSE(stalled);     // so the motors notice nothing
}

TEST(Drive, TheWatchdogStopsASilentRobot) {
  SimRobot robot(flat_floor(-10, -10, 10, 10), {}, exact(), 1);
  run(robot, drive(0.4), 3.0);
  double v = 0.0;
  const auto wait = [&](double seconds) {
    for (int i = 0; i < std::lround(seconds / 0.02); ++i) {
      const auto inputs = robot.read();
      if (!inputs->odometry.empty()) v = inputs->odometry.back().v;
    }
  };
  wait(1.9);
  EXPECT_NEAR(v, 0.4, 1e-3);
  wait(1.7);
  EXPECT_EQ(v, 0.0);
  run(robot, drive(0.4), 2.0);  // and goes on with the next command
  wait(0.1);
  EXPECT_NEAR(v, 0.4, 1e-3);
}

TEST(Drive, SpeedFollowsATrapezoid) {
  const robot::RobotModel model;
  SimRobot robot(flat_floor(-10, -10, 10, 10), model, exact(), 1);
  double last = 0.0;
  double fastest_gain = 0.0;
  double top = 0.0;
  run(robot, drive(5.0), 5.0, [&](const robot::Inputs& inputs) {
    for (const auto& o : inputs.odometry) {
      fastest_gain = std::max(fastest_gain, (o.v - last) / model.odometry_period);
      last = o.v;
      top = std::max(top, o.v);
    }
  });
  EXPECT_NEAR(top, model.max_v, 1e-3);
  EXPECT_NEAR(fastest_gain, model.max_accel, 0.011);  // speeds are reported in mm/s
}

TEST(Drive, AStepTooHighStopsTheRobotAndALowerOneDoesNot) {
  for (const double height : {0.06, 0.10, 0.14, 0.3}) {
    arenas::Arena arena = flat_floor(-2, -2, 1, 2);
    arena.floor.push_back({rectangle(1, -2, 4, 2), height, 0.0, 0.0, "step"});
    SimRobot robot(arena, {}, exact(), 1);
    bool stalled = false;
    run(robot, drive(0.4), 8.0, [&](const robot::Inputs& inputs) {
      for (const auto& o : inputs.odometry) stalled = o.stalled;
    });
    SCOPED_TRACE("step of " + std::to_string(height) + " m, robot at " + std::to_string(where(robot).x));
    if (height > 0.10) {
      EXPECT_NEAR(where(robot).x + 0.254, 1.0, 0.02);
      EXPECT_TRUE(stalled);
    } else {
      EXPECT_GT(where(robot).x, 1.5);
      EXPECT_FALSE(stalled);
    }
  }
}

TEST(Drive, AHangingWallLetsTheRobotThroughAndAWallBelowTheFloorToo) {
  arenas::Arena hanging = flat_floor(-2, -2, 4, 2);
  add_wall(hanging, 1.0, -2, 1.02, 2, 1.2, 0.6);
  SimRobot under(hanging, {}, exact(), 1);
  run(under, drive(0.4), 6.0);
  EXPECT_GT(where(under).x, 1.8);

  arenas::Arena elevated = flat_floor(-2, -2, 4, 2, 1.2);
  add_wall(elevated, 1.0, -2, 1.02, 2, 1.2);
  SimRobot above(elevated, {}, exact(), 1);
  run(above, drive(0.4), 6.0);
  EXPECT_GT(where(above).x, 1.8);
}

}  // namespace
}  // namespace rubble::sim::test
