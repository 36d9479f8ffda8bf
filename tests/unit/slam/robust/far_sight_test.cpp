#include <gtest/gtest.h>

#include <string>

#include "slam/robust/robust_mapper.h"
#include "tests/support/slam_outcome.h"
#include "tests/support/slam_world.h"

/// Scanners that see farther than any that is known by name.
namespace rubble::slam {
namespace {

using mrpt::math::TPoint2D;
using robot::Inputs;
using robot::RobotModel;

constexpr double kGround = 300.0;  ///< a side [m]

/// Open ground within four walls, with boxes strewn over it by a seed; none stands on the way of ground_drive().
slam_test::World open_ground(std::uint64_t seed) {
  Rng rng(seed, "ground");
  slam_test::World world;
  slam_test::add_box(world, -0.5 * kGround, -0.5 * kGround, 0.5 * kGround, 0.5 * kGround);
  while (world.size() < 4 * 61) {
    const TPoint2D at(rng.uniform(-0.5, 0.5) * kGround, rng.uniform(-0.5, 0.5) * kGround);
    const TPoint2D size(rng.uniform(0.5, 8.0), rng.uniform(0.5, 8.0));
    const bool in_the_way = at.x + size.x > -3.0 && at.x < 18.0 && at.y + size.y > -3.0 && at.y < 13.0;
    if (!in_the_way) slam_test::add_box(world, at.x, at.y, at.x + size.x, at.y + size.y);
  }
  return world;
}

/// Once round a rectangle and on along its first sides, every third scan of it.
Trajectory ground_drive() {
  const slam_test::Drive drive = slam_test::drive_through(
      {{0.0, 0.0}, {10.0, 0.0}, {10.0, 6.0}, {0.0, 6.0}, {0.0, 0.0}, {10.0, 0.0}, {10.0, 2.0}}, 0.0);
  Trajectory thinned;
  for (std::size_t i = 0; i < drive.truth.size(); i += 3) thinned.push_back(drive.truth[i]);
  return thinned;
}

RobotModel far_sighted(double reach) {
  RobotModel model;
  model.laser.name = robot::kGenericLaser;
  model.laser.beams = 720;
  model.laser.angle_step = 2.0 * kPi / 720;
  model.laser.angle_min = -kPi;
  model.laser.range_max = reach;
  return model;
}

/// Scans that say why beams fail: those that met nothing.
std::vector<Inputs> ground_ticks(const slam_test::World& world, const Trajectory& truth, const RobotModel& model,
                                 std::uint64_t seed) {
  std::vector<Inputs> ticks = slam_test::record(world, {truth, 0.3}, model, 1.0, 0.02, seed);
  for (Inputs& tick : ticks)
    for (robot::LaserScan& scan : tick.scans) scan.codes.assign(scan.ranges.size(), 0);
  return ticks;
}

/// What other scanners take in halls; before rasters and stamped scans had a size that they do not go beyond, it was 8,
/// 33 and 142 million units. The errors seen are 8 to 12 mm.
TEST(FarSight, NoScanOfOpenGroundTakesMoreWorkThanOneOfAHall) {
  const Trajectory truth = ground_drive();
  std::uint64_t seed = 0;
  for (const double reach : {50.0, 100.0, 200.0}) {
    ++seed;
    SCOPED_TRACE("reach " + std::to_string(reach) + ", seed " + std::to_string(seed));
    const RobotModel model = far_sighted(reach);
    RobustMapper mapper(model, {}, 1);
    slam_test::play(mapper, ground_ticks(open_ground(seed), truth, model, seed));
    EXPECT_LT(slam_test::figure(mapper, MapperFigure::kMostWork), 9.0);
    EXPECT_LT(slam_test::first_pose_rmse(mapper.trajectory(), truth), 0.02);
    EXPECT_LT(slam_test::first_pose_rmse(mapper.live_trajectory(), truth), 0.02);
    EXPECT_GT(slam_test::figure(mapper, "loops_searched"), 20.0);
  }
}

}  // namespace
}  // namespace rubble::slam
