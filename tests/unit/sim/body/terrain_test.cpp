#include "sim/body/terrain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angle.h"
#include "base/rng.h"
#include "sim/body/attitude.h"
#include "sim/body/drive.h"
#include "sim/laser/rays.h"
#include "tests/support/sim_arena.h"
#include "tests/support/sim_random_scene.h"

namespace rubble::sim::test {
namespace {

TEST(Terrain, HasTheArenasHeightEverywhere) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const arenas::Arena arena = random_maze(seed);
    const Terrain terrain(arena, 0.1);
    Rng rng(seed, "terrain");
    for (int i = 0; i < 5000; ++i) {
      const double x = rng.uniform(arena.min_corner.x - 0.5, arena.max_corner.x + 0.5);
      const double y = rng.uniform(arena.min_corner.y - 0.5, arena.max_corner.y + 0.5);
      const double floor = arenas::floor_height(arena, {x, y});
      EXPECT_NEAR(terrain.at({x, y}).height, std::isfinite(floor) ? floor : 0.0, 1e-9);
    }
  }
}

TEST(Terrain, SlopeIsTheChangeOfHeight) {
  const arenas::Arena arena = random_maze(7);
  const Terrain terrain(arena, 0.1);
  Rng rng(7, "slope");
  int compared = 0;
  for (int i = 0; i < 5000; ++i) {
    const double x = rng.uniform(arena.min_corner.x, arena.max_corner.x);
    const double y = rng.uniform(arena.min_corner.y, arena.max_corner.y);
    const double h = 1e-5;
    const Ground g = terrain.under_wheel({x, y});
    const double gx = (terrain.under_wheel({x + h, y}).height - terrain.under_wheel({x - h, y}).height) / (2 * h);
    const double gy = (terrain.under_wheel({x, y + h}).height - terrain.under_wheel({x, y - h}).height) / (2 * h);
    if (std::abs(gx) > 3.0 || std::abs(gy) > 3.0) continue;  // across an edge
    compared += std::abs(gx - g.gx) < 1e-5 && std::abs(gy - g.gy) < 1e-5 ? 1 : 0;
  }
  EXPECT_GT(compared, 4950);  // the rest lies within 10 um of a kink
}

TEST(Terrain, PaperLowersFrictionWhereItLies) {
  arenas::Arena arena = flat_floor(-2, -2, 2, 2);
  arena.sheets.push_back({{{0, 0}, {1, 0}, {0, 1}}, 0.25});
  arena.sheets.push_back({rectangle(0.2, 0.2, 0.3, 0.3), 0.1});
  const Terrain terrain(arena, 0.1);
  EXPECT_EQ(terrain.at({-0.1, 0.5}).friction, arena.floor_friction);
  EXPECT_EQ(terrain.at({0.1, 0.1}).friction, 0.25);
  EXPECT_EQ(terrain.at({0.25, 0.25}).friction, 0.1);                 // the slipperier of two
  EXPECT_EQ(terrain.at({0.6, 0.6}).friction, arena.floor_friction);  // beyond the diagonal
}

TEST(Terrain, AWheelMeetsALowStepAsAChamferAndAHighOneNotAtAll) {
  for (const double height : {0.05, 0.1, 0.2}) {
    arenas::Arena arena = flat_floor(-2, -2, 1, 2);
    arena.floor.push_back({rectangle(1, -2, 3, 2), height, 0.0, 0.0, "step"});
    const Terrain terrain(arena, 0.1);
    const bool climbed = height <= 0.1;
    EXPECT_NEAR(terrain.under_wheel({1.0 - 0.03, 0.0}).height, climbed ? height - 0.03 : 0.0, 1e-9);
    EXPECT_NEAR(terrain.under_wheel({1.0 - 0.03, 0.0}).gx, climbed ? 1.0 : 0.0, 1e-9);
    EXPECT_EQ(terrain.under_wheel({1.0 - 0.11, 0.0}).height, 0.0);
    EXPECT_NEAR(terrain.under_wheel({1.1, 0.0}).height, height, 1e-9);
  }
}

TEST(Attitude, OnAPlaneTheStanceIsThePlane) {
  const robot::RobotModel model;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "plane");
    arenas::Arena arena = flat_floor(-3, -3, 3, 3);
    const double gx = rng.uniform(-0.6, 0.6);
    const double gy = rng.uniform(-0.6, 0.6);
    const double heading = rng.uniform(-kPi, kPi);
    arena.floor[0].gx = gx;
    arena.floor[0].gy = gy;
    const Terrain terrain(arena, 0.1);
    WorldState state;
    state.pose = {0.3, -0.2, heading};
    state.stance = stance_on(ground_under(terrain, model, state.pose), model);
    const Placement base = base_placement(state);
    const Eigen::Vector3d normal = Eigen::Vector3d(-gx, -gy, 1.0).normalized();
    EXPECT_LT((base.R.col(2) - normal).norm(), 1e-12);
    EXPECT_NEAR(base.p.z(), arenas::floor_height(arena, {0.3, -0.2}), 1e-12);
    // Seen from above the nose points where the heading says.
    EXPECT_NEAR(std::atan2(base.R(1, 0), base.R(0, 0)), heading, 1e-12);
  }
}

TEST(Attitude, EdgesAreFeltAsRampsNotAsJumps) {
  Attitude attitude({0.0, 0.0, 0.0});
  double last = 0.0;
  double steepest = 0.0;
  for (int i = 0; i < 30; ++i) {
    attitude.step({0.1, 0.2, 0.0}, 0.01);
    steepest = std::max(steepest, attitude.stance().z - last);
    last = attitude.stance().z;
  }
  EXPECT_LT(steepest, 0.1 / 3.0);
  EXPECT_NEAR(attitude.stance().z, 0.1, 1e-3);
  EXPECT_NEAR(attitude.stance().pitch, 0.2, 1e-3);
}

}  // namespace
}  // namespace rubble::sim::test
