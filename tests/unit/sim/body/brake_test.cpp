// Braking without a ramp, as ARCOS does when its motors are switched off.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/sim_arena.h"

namespace rubble::sim {
namespace {

/// The way from a speed to rest.
double stopping_way(bool hard, double v, double w) {
  const arenas::Arena arena = test::flat_floor(-5.0, -5.0, 5.0, 5.0);
  SimRobot robot(arena, robot::RobotModel{}, test::exact(), 1);
  for (int i = 0; i < 150; ++i) {
    robot.command({{v, w}, {}});
    robot.read();
  }
  const mrpt::math::TPose2D from = robot.truth().back().pose;
  double way = 0.0, turn = 0.0;
  mrpt::math::TPose2D last = from;
  for (int i = 0; i < 200; ++i) {
    robot.command({{0.0, 0.0}, {}, hard});
    robot.read();
    const mrpt::math::TPose2D now = robot.truth().back().pose;
    way += std::hypot(now.x - last.x, now.y - last.y);
    turn += std::abs(wrap_angle(now.phi - last.phi));
    last = now;
  }
  return w != 0.0 ? turn : way;
}

TEST(Brake, StopsAsHardAsTheMotorsCanWhereACommandKeepsItsRamp) {
  // v^2 / 2a with the ramp's 0.3 m/s^2; the motors push 100 N against 14 kg and what turns with the wheels.
  EXPECT_NEAR(stopping_way(false, 0.6, 0.0), 0.6 * 0.6 / (2.0 * 0.3), 0.03);
  EXPECT_LT(stopping_way(true, 0.6, 0.0), 0.06);
  EXPECT_LT(stopping_way(true, 0.0, 1.0), 0.5 * stopping_way(false, 0.0, 1.0));
}

TEST(Brake, TheNextCommandDrivesAgain) {
  const arenas::Arena arena = test::flat_floor(-5.0, -5.0, 5.0, 5.0);
  SimRobot robot(arena, robot::RobotModel{}, test::exact(), 1);
  robot.command({{}, {}, true});
  for (int i = 0; i < 100; ++i) {
    robot.command({{0.3, 0.0}, {}});
    robot.read();
  }
  EXPECT_GT(robot.truth().back().pose.x, 0.3);
}

}  // namespace
}  // namespace rubble::sim
