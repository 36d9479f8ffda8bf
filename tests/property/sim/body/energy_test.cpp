#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "base/rng.h"
#include "sim/body/drive.h"
#include "tests/support/sim_arena.h"

namespace rubble::sim::test {
namespace {

using mrpt::math::TPose2D;

/// Kinetic and potential energy of a robot on a plane floor [J].
double energy(const robot::RobotModel& model, const DriveParameters& p, const Drive& drive, const Ground& ground,
              const TPose2D& pose, const PlanVelocity& v) {
  const double rise = ground.gx * v.x + ground.gy * v.y;
  const double height = ground.gx * pose.x + ground.gy * pose.y;
  return 0.5 * model.mass * (v.x * v.x + v.y * v.y + rise * rise) + 0.5 * drive.yaw_inertia() * v.w * v.w +
         0.5 * p.rotating_mass * (std::pow(drive.left().speed, 2) + std::pow(drive.right().speed, 2)) +
         model.mass * 9.80665 * height;
}

TEST(Energy, NeverAppearsWhileTheMotorsRest) {
  const robot::RobotModel model;
  const DriveParameters parameters;
  double most = 0.0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "energy");
    arenas::Arena arena = flat_floor(-8, -8, 8, 8);
    const double gx = rng.uniform(-0.4, 0.4);
    const double gy = rng.uniform(-0.4, 0.4);
    arena.floor[0].gx = gx;
    arena.floor[0].gy = gy;
    arena.floor[0].z = -8.0 * (gx + gy);
    arena.floor_friction = rng.uniform(0.05, 1.0);
    if (seed % 3 == 0) arena.sheets.push_back({rectangle(-8, -8, 8, 0), 0.25});
    const Terrain terrain(arena, model.climbable_step);
    Drive drive(model, parameters);
    const double heading = rng.uniform(-3.0, 3.0);
    const double vx = rng.uniform(-1.0, 1.0);
    const double vy = rng.uniform(-1.0, 1.0);
    const double w = rng.uniform(-3.0, 3.0);
    TPose2D pose{0.0, 0.0, heading};
    PlanVelocity v{vx, vy, w};
    const Ground plane = terrain.at({0.0, 0.0});
    double before = energy(model, parameters, drive, plane, pose, v);
    for (int i = 0; i < 300; ++i) {
      v = drive.step(pose, ground_under(terrain, model, pose), v, {0.0, 0.0, true}, {}, 0.01);
      pose = {pose.x + 0.01 * v.x, pose.y + 0.01 * v.y, pose.phi + 0.01 * v.w};
      const double after = energy(model, parameters, drive, plane, pose, v);
      most = std::max(most, after - before);
      ASSERT_LE(after, before + 1e-5) << "step " << i;
      before = after;
    }
  }
  std::cout << "largest gain in one step: " << most << " J\n";
}

}  // namespace
}  // namespace rubble::sim::test
