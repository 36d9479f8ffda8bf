#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "base/angle.h"
#include "sim/body/terrain.h"
#include "tests/support/sim_arena.h"

namespace rubble::sim::test {
namespace {

TEST(FloorFriction, AWheelOnAPatchHasItsFriction) {
  arenas::Arena arena = flat_floor(-2, -2, 2, 2);
  arena.floor.push_back({rectangle(0, 0, 1, 1), 0.05, 0.0, 0.0, "ice", 0.1});
  arena.floor.push_back({rectangle(-1, 0, 0, 1), -0.05, 0.0, 0.0, "below", 0.2});
  arena.sheets.push_back({rectangle(0.5, 0.5, 1.5, 1.5), 0.25});
  const Terrain terrain(arena, 0.1);
  EXPECT_EQ(terrain.at({0.3, 0.3}).friction, 0.1);
  EXPECT_EQ(terrain.under_wheel({0.3, 0.3}).friction, 0.1);
  EXPECT_EQ(terrain.at({0.3, -0.3}).friction, arena.floor_friction);
  EXPECT_EQ(terrain.at({-0.5, 0.5}).friction, arena.floor_friction);  // the higher patch carries
  EXPECT_EQ(terrain.at({0.7, 0.7}).friction, 0.25);                   // the paper's
  EXPECT_EQ(terrain.at({5.0, 5.0}).friction, arena.floor_friction);   // the ground beyond
}

/// How far down a slope a robot that wants to stand still gets in a second [m, in plan].
double slid(double angle, std::optional<double> friction) {
  arenas::Arena arena = slope(-20, -5, 5, 5, angle);
  arena.floor[0].friction = friction;
  SimRobot robot(arena, {}, exact(), 1);
  run(robot, drive(0.0), 1.0);
  return -robot.truth().back().pose.x;
}

/// g (sin - friction cos) down the slope; below the angle of friction it stands.
TEST(FloorFriction, ARobotSlidesDownASlopeSteeperThanTheAngleOfFriction) {
  const double angle = deg_to_rad(15.0);
  EXPECT_LT(slid(angle, std::nullopt), 0.01);
  EXPECT_LT(slid(angle, 1.1 * std::tan(angle)), 0.02);
  for (const double friction : {0.05, 0.1, 0.2}) {
    const double wanted = 0.5 * 9.81 * (std::sin(angle) - friction * std::cos(angle)) * std::cos(angle);
    const double distance = slid(angle, friction);
    std::cout << "friction " << friction << ": slid " << distance << " m, wanted " << wanted << " m\n";
    EXPECT_NEAR(distance, wanted, 0.015 * wanted);
  }
}

}  // namespace
}  // namespace rubble::sim::test
