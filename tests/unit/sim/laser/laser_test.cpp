#include "sim/laser/laser.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

#include "base/angle.h"
#include "tests/support/sim_arena.h"

namespace rubble::sim::test {
namespace {

const std::size_t kFront = 340;  ///< step 384 of 44..725 looks ahead

/// What a robot that stands at `pose` with its laser aimed by `aim` sees, without noise.
robot::LaserScan look(const arenas::Arena& arena, const mrpt::math::TPose2D& pose, const robot::LaserAim& aim = {},
                      const std::vector<Sphere>& balls = {}) {
  const robot::RobotModel model;
  Laser laser(arena, model, 0.0, true, 1);
  WorldState state;
  state.pose = pose;
  state.stance.z = std::max(0.0, arenas::floor_height(arena, {pose.x, pose.y}));
  state.aim = aim;
  WorldState later = state;
  later.stamp = Stamp::from_seconds(0.1);
  return laser.scan(Stamp::from_seconds(0.0043), {state, later}, balls);
}

TEST(Laser, LevelRobotSeesNoPhantomWall) {
  const robot::LaserScan scan = look(flat_floor(-10, -10, 10, 10), {});
  EXPECT_EQ(scan.ranges.size(), 682u);
  for (const float range : scan.ranges) EXPECT_EQ(range, std::numeric_limits<float>::infinity());
}

/// 1081 beams in 18.75 ms: its rotor's zero is where the first beam leaves, and the last one ends the sweep.
TEST(Laser, AUtm30lxSeesTwentyMetresFar) {
  robot::RobotModel model;
  model.laser = robot::laser_model("UTM-30LX");
  const SweepTimes times(model.laser);
  EXPECT_NEAR(times.first_beam, 0.0, 1e-12);
  EXPECT_NEAR(times.sent, 1080 * 0.025 / 1440, 1e-9);
  Laser laser(room(-20, -20, 20, 20), model, 0.0, true, 1);
  WorldState state;
  WorldState later = state;
  later.stamp = Stamp::from_seconds(0.1);
  const robot::LaserScan scan = laser.scan(Stamp::from_seconds(0.0), {state, later}, {});
  ASSERT_EQ(scan.ranges.size(), 1081u);
  EXPECT_NEAR(scan.ranges[540], 19.98 - 0.145, 0.0011) << "straight ahead";
  EXPECT_NEAR(scan.ranges[540 + 360], 19.98, 0.0011) << "to the left";
  EXPECT_NEAR(scan.ranges[540 - 360], 19.98, 0.0011);
}

TEST(Laser, ALevelRobotInFrontOfARampSeesItAsAWall) {
  arenas::Arena arena = flat_floor(-5, -5, 1, 5);
  add_ramp(arena, 1, -5, 5, 5, deg_to_rad(10.0));
  const robot::LaserScan scan = look(arena, {});
  // The ramp reaches the scan plane 0.35 / tan(10 deg) behind its foot; the laser sits 0.145 m ahead.
  EXPECT_NEAR(scan.ranges[kFront], 1.0 + 0.35 / std::tan(deg_to_rad(10.0)) - 0.145, 0.001);
}

TEST(Laser, TenDegreesNoseDownTheFloorAppearsAtTwoMetres) {
  const robot::LaserScan scan = look(flat_floor(-10, -10, 10, 10), {}, {deg_to_rad(-10.0), 0.0});
  std::cout << "phantom wall at " << scan.ranges[kFront] << " m\n";
  EXPECT_NEAR(scan.ranges[kFront], 0.35 / std::sin(deg_to_rad(10.0)), 0.001);
  // It is a straight wall across the way: the whole scan plane meets the floor in one line.
  for (std::size_t i = kFront - 150; i <= kFront + 150; ++i) {
    EXPECT_NEAR(scan.ranges[i] * std::cos(scan.bearing(i)), 0.35 / std::sin(deg_to_rad(10.0)), 0.001);
  }
  const robot::LaserScan five = look(flat_floor(-10, -10, 10, 10), {}, {deg_to_rad(-5.1), 0.0});
  EXPECT_NEAR(five.ranges[kFront], 0.35 / std::sin(deg_to_rad(5.1)), 0.001);
}

TEST(Laser, RollBringsTheFloorUpOnTheLowSideOnly) {
  const robot::LaserScan scan = look(flat_floor(-10, -10, 10, 10), {}, {0.0, deg_to_rad(10.0)});  // left side up
  const std::size_t right = kFront - 256;                                                         // 90 deg
  const std::size_t left = kFront + 256;
  EXPECT_NEAR(scan.ranges[right], 0.35 / std::sin(deg_to_rad(10.0)), 0.001);
  EXPECT_EQ(scan.ranges[left], std::numeric_limits<float>::infinity());
}

TEST(Laser, RangeToAWallGrowsByOneOverCosine) {
  arenas::Arena arena = flat_floor(-5, -5, 5, 5);
  add_wall(arena, 2.145, -5, 2.165, 5, 2.4);
  for (const double pitch_deg : {-9.0, -5.0, 0.0, 5.0, 10.0}) {
    const robot::LaserScan scan = look(arena, {}, {deg_to_rad(pitch_deg), 0.0});
    const double expected = std::min(2.0 / std::cos(deg_to_rad(pitch_deg)),
                                     pitch_deg < 0.0 ? 0.35 / std::sin(deg_to_rad(-pitch_deg)) : 1e9);
    EXPECT_NEAR(scan.ranges[kFront], expected, 0.0006) << pitch_deg << " deg";
  }
}

TEST(Laser, APlaneAboveTheWallMissesIt) {
  arenas::Arena arena = flat_floor(-5, -5, 5, 5);
  add_wall(arena, 2.145, -5, 2.165, 5, 0.5);
  EXPECT_NEAR(look(arena, {}).ranges[kFront], 2.0, 0.001);
  const double over = std::atan((0.5 - 0.35) / 2.0);
  EXPECT_NEAR(look(arena, {}, {over - 0.005, 0.0}).ranges[kFront], 2.0 / std::cos(over), 0.002);
  EXPECT_EQ(look(arena, {}, {over + 0.005, 0.0}).ranges[kFront], std::numeric_limits<float>::infinity());
}

TEST(Laser, AVeilHidesWhatItCoversOnly) {
  arenas::Arena arena = flat_floor(-5, -5, 5, 5);
  add_wall(arena, 1.145, -5, 1.165, 5, 1.2, 0.6);
  add_wall(arena, 2.145, -5, 2.165, 5);
  EXPECT_NEAR(look(arena, {}).ranges[kFront], 2.0, 0.001);
  EXPECT_NEAR(look(arena, {}, {deg_to_rad(20.0), 0.0}).ranges[kFront], 1.0 / std::cos(deg_to_rad(20.0)), 0.001);
}

TEST(Laser, PaperIsSeenOnlyWhileItReachesTheScanPlane) {
  const arenas::Arena arena = flat_floor(-5, -5, 5, 5);
  const auto ball = [](double radius) { return std::vector<Sphere>{{1.645, 0.0, radius, radius}}; };
  EXPECT_EQ(look(arena, {}, {}, ball(0.12)).ranges[kFront], std::numeric_limits<float>::infinity());  // 0.24 m high
  EXPECT_LT(look(arena, {}, {}, ball(0.20)).ranges[kFront], 1.5f);                                    // 0.40 m high
  EXPECT_LT(look(arena, {}, {deg_to_rad(-6.0), 0.0}, ball(0.12)).ranges[kFront], 1.6f);  // the plane comes down to it
}

TEST(Laser, OutOfRangeIsAMissAndTooNearIsNoMeasurement) {
  arenas::Arena arena = flat_floor(-8, -8, 8, 8);
  add_wall(arena, 4.150, -8, 4.17, 8);  // 4.005 m ahead of the laser
  add_wall(arena, -8, 0.015, 8, 0.03);  // 15 mm beside it
  const robot::LaserScan scan = look(arena, {});
  EXPECT_EQ(scan.ranges[kFront], std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::isnan(scan.ranges[kFront + 256]));
}

TEST(Laser, RangesAreWholeMillimetres) {
  SimRobot robot(room(-2, -2, 2, 2), {}, SimConfig{}, 3);
  run(robot, drive(0.0), 1.0, [](const robot::Inputs& inputs) {
    for (const auto& scan : inputs.scans) {
      for (const float range : scan.ranges) {
        if (!std::isfinite(range)) continue;
        const float mm = range * 1000.0f;
        EXPECT_NEAR(mm, std::round(mm), 0.001f);
      }
    }
  });
}

TEST(Laser, ScansCarryTheTimeOfTheirFirstBeamAndArriveWhenTheSweepIsOver) {
  const robot::RobotModel model;
  SimRobot robot(room(-2, -2, 2, 2), model, SimConfig{}, 3);
  std::vector<robot::LaserScan> scans;
  std::vector<Stamp> arrivals;
  run(robot, drive(0.0), 2.0, [&](const robot::Inputs& inputs) {
    for (const auto& scan : inputs.scans) {
      scans.push_back(scan);
      arrivals.push_back(inputs.now);
    }
  });
  ASSERT_EQ(scans.size(), 20u);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const double zero = 0.1 * static_cast<double>(i);
    EXPECT_NEAR(scans[i].stamp.seconds(), zero + 44 * 97.65625e-6, 1e-8);
    EXPECT_NEAR(scans[i].beam_stamp(681).seconds(), zero + 725 * 97.65625e-6, 1e-8);
    EXPECT_NEAR(arrivals[i].seconds(), zero + 0.08, 1e-9);  // first tick after step 768, 75 ms after zero
  }
}

/// Distance from p to the walls of room(-2, -2, 2, 2).
double off_the_wall(double x, double y) {
  const double to_x = std::abs(std::abs(x) - 1.98);
  const double to_y = std::abs(std::abs(y) - 1.98);
  return std::min(to_x, to_y);
}

TEST(Laser, EveryBeamOfATurningRobotStartsFromItsOwnPose) {
  SimRobot robot(room(-2, -2, 2, 2), {}, exact(), 3);
  double worst = 0.0;
  double worst_without = 0.0;
  std::vector<robot::LaserScan> scans;
  run(robot, drive(0.15, 1.047), 10.0, [&](const robot::Inputs& inputs) {
    for (const auto& scan : inputs.scans) scans.push_back(scan);
  });
  for (const robot::LaserScan& scan : scans) {
    const auto first = pose_at(robot.truth(), scan.stamp);
    for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
      const auto own = pose_at(robot.truth(), scan.beam_stamp(i));
      if (!own || !std::isfinite(scan.ranges[i])) continue;
      const double x = 0.145 + scan.ranges[i] * std::cos(scan.bearing(i));
      const double y = scan.ranges[i] * std::sin(scan.bearing(i));
      const auto hit = own->composePoint({x, y});
      const auto smeared = first->composePoint({x, y});
      worst = std::max(worst, off_the_wall(hit.x, hit.y));
      worst_without = std::max(worst_without, off_the_wall(smeared.x, smeared.y));
    }
  }
  std::cout << "hits off the wall: " << worst * 1e3 << " mm; taken from the first beam's pose: " << worst_without * 1e3
            << " mm\n";
  EXPECT_LT(worst, 0.004);
  EXPECT_GT(worst_without, 0.05);
}

TEST(Laser, WithoutSweepTheWholeScanIsTakenAtItsStamp) {
  SimConfig config = exact();
  config.sweep = false;
  SimRobot robot(room(-2, -2, 2, 2), {}, config, 3);
  double worst = 0.0;
  run(robot, drive(0.15, 1.047), 8.0, [&](const robot::Inputs& inputs) {
    for (const auto& scan : inputs.scans) {
      EXPECT_EQ(scan.beam_period, 0.0);
      const auto pose = pose_at(robot.truth(), scan.stamp);
      if (!pose) continue;
      for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
        if (!std::isfinite(scan.ranges[i])) continue;
        const auto hit = pose->composePoint(
            {0.145 + scan.ranges[i] * std::cos(scan.bearing(i)), scan.ranges[i] * std::sin(scan.bearing(i))});
        worst = std::max(worst, off_the_wall(hit.x, hit.y));
      }
    }
  });
  EXPECT_LT(worst, 0.004);
}

/// A tunnel's ceiling 0.60 m up: level beams pass below it, a laser that looks up by `tilt` meets it at
/// (0.60 - 0.35) / sin(tilt), and one that stands higher than the ceiling meets its edge.
TEST(Laser, ATunnelsCeilingIsSeenOnlyWhenTheLaserLooksUpOrStandsHigher) {
  arenas::Arena arena = flat_floor(-5, -5, 5, 5);
  arena.solids.push_back({rectangle(0.4, -0.6, 1.6, 0.6), 0.60, 0.62, "tunnel"});
  const robot::RobotModel model;
  const RayWalk walk(arenas::faces(arena));
  const ScanFaces faces(arenas::faces(arena));
  PlaneCast plane(faces);
  const BeamTable table(model.laser);
  const auto ahead = [&](double tilt, double floor) {
    WorldState state;
    state.stance.z = floor;
    state.aim.pitch = tilt;
    std::vector<float> ranges;
    plane.cast(laser_placement(state, model), table, 4.0, {}, ranges);
    return static_cast<double>(ranges[340]);
  };
  EXPECT_TRUE(std::isinf(ahead(0.0, 0.0)));
  for (const double tilt_deg : {12.0, 20.0, 30.0}) {
    const double tilt = deg_to_rad(tilt_deg);
    EXPECT_NEAR(ahead(tilt, 0.0), 0.25 / std::sin(tilt), 1e-4) << tilt_deg;
  }
  EXPECT_NEAR(ahead(0.0, 0.26), 0.4 - 0.145, 1e-4);  // at 0.61 m: the board's edge
  EXPECT_TRUE(std::isinf(ahead(0.0, 0.30)));         // above it
}

}  // namespace
}  // namespace rubble::sim::test
