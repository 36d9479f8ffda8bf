#include <gtest/gtest.h>

#include <iostream>

#include "base/planar.h"
#include "robot/slope_creep.h"
#include "slam/robust/robust_mapper.h"
#include "tests/support/sim_arena.h"

namespace rubble::sim::test {
namespace {

struct Turn {
  double slid = 0.0;   ///< by the truth [m]
  double error = 0.0;  ///< of the mapper's position [m]
};

/// A robot that turns on the spot for ten seconds, on a slope that rises along two bare walls whose ends are out of its
/// sight.
Turn turned(double w, double wheel_friction) {
  arenas::Arena arena = slope(-20, -5, 20, 5, deg_to_rad(10.0));
  add_wall(arena, -20, 0.8, 20, 0.82, 9.0);
  add_wall(arena, -20, -0.82, 20, -0.8, 9.0);
  SimRobot robot(arena, {}, {}, 1);
  slam::RobustConfig config = slam::suited_to(robot.model().laser, {});
  config.tracker.wheel_friction = wheel_friction;
  slam::RobustMapper mapper(robot.model(), config, 1);
  const auto map = [&](const robot::Inputs& inputs) { mapper.update(inputs); };
  run(robot, drive(0.0), 1.0, map);
  run(robot, drive(0.0, w), 10.0, map);
  run(robot, drive(0.0), 1.0, map);
  const mrpt::math::TPoint2D truth = position(robot.truth().back().pose);
  return {length(truth), distance(truth, position(mapper.pose()))};
}

/// Neither wheels nor scans tell that it slides down; the slope does.
TEST(TurnOnASlope, TheMapperKnowsThatTheRobotSlidesDown) {
  for (const double w : {0.5, -1.0}) {
    const Turn expected = turned(w, 0.8);
    const Turn unexpected = turned(w, 0.0);
    std::cout << w << " rad/s: slid " << expected.slid << " m, off by " << expected.error << " m; by wheels and scans "
              << unexpected.error << " m\n";
    EXPECT_GT(expected.slid, 0.3);
    EXPECT_LT(expected.error, 0.5 * expected.slid);
    EXPECT_LT(expected.error, 0.6 * unexpected.error);
    EXPECT_GT(unexpected.error, 0.6 * unexpected.slid);
  }
}

/// What the robot takes the floor to be like.
TEST(TurnOnASlope, ArenasAreOfTheFrictionThatTheRobotExpects) {
  EXPECT_EQ(arenas::Arena().floor_friction, robot::kRubberOnWood);
}

}  // namespace
}  // namespace rubble::sim::test
