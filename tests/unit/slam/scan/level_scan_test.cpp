#include "slam/scan/level_scan.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/slam_world.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using mrpt::math::TPose3D;

constexpr float kMiss = std::numeric_limits<float>::infinity();
constexpr float kUnmeasured = std::numeric_limits<float>::quiet_NaN();

robot::LaserScan four_beams(const std::vector<float>& ranges) {
  robot::LaserScan scan;
  scan.angle_min = -kPi / 2.0;
  scan.angle_step = kPi / 2.0;
  scan.range_min = 0.02;
  scan.range_max = 4.0;
  scan.ranges = ranges;
  return scan;
}

void expect_near(const TPoint2D& a, double x, double y) {
  EXPECT_NEAR(a.x, x, 1e-6);
  EXPECT_NEAR(a.y, y, 1e-6);
}

TEST(LevelScan, ReturnsLieWhereTheMountPutsThem) {
  LevelScan level_scan(TPose3D(0.1, 0.2, 0.3, kPi / 2.0, 0.0, 0.0), {});
  const ScanPoints points = level_scan.points(four_beams({1.0f, 2.0f, 3.0f}));
  ASSERT_EQ(points.hits.size(), 3u);
  expect_near(points.origin, 0.1, 0.2);
  expect_near(points.hits[0], 1.1, 0.2);
  expect_near(points.hits[1], 0.1, 2.2);
  expect_near(points.hits[2], -2.9, 0.2);
}

TEST(LevelScan, NanAndTooNearAreNothing) {
  LevelScanConfig config;
  config.carve_misses = true;
  LevelScan level_scan(TPose3D(), config);
  const ScanPoints points = level_scan.points(four_beams({kUnmeasured, 0.01f, 1.0f, 0.0f}));
  EXPECT_EQ(points.hits.size(), 1u);
  EXPECT_TRUE(points.passes.empty());
  ASSERT_EQ(points.rays.size(), 1u);
  EXPECT_FALSE(points.rays[0].joined);
}

TEST(LevelScan, MissesFreeNothingUnlessAsked) {
  LevelScan quiet(TPose3D(), {});
  EXPECT_TRUE(quiet.points(four_beams({kMiss, kMiss, 1.0f})).passes.empty());
  LevelScanConfig config;
  config.carve_misses = true;
  LevelScan carving(TPose3D(), config);
  const ScanPoints points = carving.points(four_beams({kMiss, 1.0f}));
  ASSERT_EQ(points.passes.size(), 1u);
  expect_near(points.passes[0], 0.0, -3.9);
  EXPECT_TRUE(points.rays[0].joined);
  EXPECT_FALSE(points.rays[0].hit);
}

/// Nose up by 10 deg the beam ahead has risen by 0.15 m after 0.85 m; the one to the side stays level.
TEST(LevelScan, AMissIsFollowedWhileItsBeamStaysLow) {
  LevelScanConfig config;
  config.carve_misses = true;
  LevelScan level_scan(TPose3D(0.0, 0.0, 0.35, 0.0, 0.0, 0.0), config);
  ScanTilt tilt;
  tilt.pitch = deg_to_rad(10.0);
  const ScanPoints points = level_scan.points(four_beams({kMiss, kMiss}), nullptr, &tilt);
  ASSERT_EQ(points.passes.size(), 2u);
  expect_near(points.passes[0], 0.0, -3.9);
  const double along = config.miss_climb / std::tan(tilt.pitch);
  expect_near(points.passes[1], along, 0.0);
  EXPECT_NEAR(along, 0.85, 0.01);
}

/// Nose down by 10 deg the beam ahead meets the floor after 2 m; what returns from there is no wall, and is told.
TEST(LevelScan, ReturnsFromTheFloorAreToldByTheirBeams) {
  LevelScanConfig config;
  config.floor_margin = 0.08;
  LevelScan level_scan(TPose3D(0.0, 0.0, 0.35, 0.0, 0.0, 0.0), config);
  ScanTilt tilt;
  tilt.pitch = deg_to_rad(-10.0);
  const ScanPoints floor = level_scan.points(four_beams({1.0f, 2.0f, 1.0f}), nullptr, &tilt);
  EXPECT_EQ(floor.hits.size(), 2u);
  EXPECT_EQ(floor.floor_beams, std::vector<int>{1});
  const ScanPoints wall = level_scan.points(four_beams({1.0f, 1.0f, 1.0f}), nullptr, &tilt);
  EXPECT_EQ(wall.hits.size(), 3u);
  EXPECT_TRUE(wall.floor_beams.empty());
  EXPECT_TRUE(level_scan.points(four_beams({1.0f, kMiss, 1.0f}), nullptr, &tilt).floor_beams.empty());
}

LevelScanConfig for_ramps() {
  LevelScanConfig config;
  config.floor_margin = 0.08;
  config.ramp_margin = 0.22;
  return config;
}

/// Nose down on a ramp the scan plane cuts the next one, which rises, in the same line from wherever it looks: no
/// second view tells that line from a wall. It lies no higher than that ramp ends.
TEST(LevelScan, WhereItLooksDownARampTheNextOneIsFloor) {
  LevelScan level_scan(TPose3D(0.0, 0.0, 0.35, 0.0, 0.0, 0.0), for_ramps());
  ScanTilt tilt;
  tilt.pitch = deg_to_rad(-10.0);
  constexpr double kAlong = 1.01;  // from the foot of both ramps, 0.178 m above it
  const ScanPoints ramp = level_scan.points(four_beams({1.0f, static_cast<float>(kAlong), 1.0f}), nullptr, &tilt);
  EXPECT_EQ(ramp.hits.size(), 2u);
  EXPECT_EQ(ramp.floor_beams, std::vector<int>{1});
  const ScanPoints wall = level_scan.points(four_beams({1.0f, 0.7f, 1.0f}), nullptr, &tilt);
  EXPECT_EQ(wall.hits.size(), 3u);
}

/// What servos leave is no ramp: a scanner of long reach keeps what it sees far off, though it is as low there.
TEST(LevelScan, WhatIsLevelWithinADegreeSeesWallsFarOff) {
  LevelScan level_scan(TPose3D(0.0, 0.0, 0.35, 0.0, 0.0, 0.0), for_ramps());
  robot::LaserScan scan = four_beams({1.0f, 8.0f, 1.0f});
  scan.range_max = 30.0;
  ScanTilt tilt;
  tilt.pitch = deg_to_rad(-1.4);
  EXPECT_EQ(level_scan.points(scan, nullptr, &tilt).hits.size(), 3u) << "0.155 m above the floor";
  tilt.pitch = deg_to_rad(-3.2);
  scan.ranges[1] = 3.5f;
  EXPECT_EQ(level_scan.points(scan, nullptr, &tilt).floor_beams, std::vector<int>{1}) << "0.155 m likewise";
}

TEST(LevelScan, ALaserNearTheGroundStillSeesWhatIsLevel) {
  LevelScan level_scan(TPose3D(0.0, 0.0, 0.15, 0.0, 0.0, 0.0), for_ramps());
  ScanTilt tilt;
  tilt.pitch = deg_to_rad(-6.0);
  const ScanPoints points = level_scan.points(four_beams({kUnmeasured, 0.4f}), nullptr, &tilt);
  EXPECT_EQ(points.hits.size(), 1u);
  EXPECT_TRUE(points.floor_beams.empty());
}

TEST(LevelScan, RangeCapTurnsFarReturnsIntoNothing) {
  LevelScanConfig config;
  config.max_range = 2.0;
  LevelScan level_scan(TPose3D(), config);
  EXPECT_EQ(level_scan.points(four_beams({1.9f, 2.1f, 3.9f})).hits.size(), 1u);
}

TEST(LevelScan, OnlyNeighbouringBeamsAreJoined) {
  LevelScan level_scan(TPose3D(), {});
  const ScanPoints points = level_scan.points(four_beams({1.0f, 1.0f, kUnmeasured, 1.0f}));
  ASSERT_EQ(points.rays.size(), 3u);
  EXPECT_TRUE(points.rays[0].joined);
  EXPECT_FALSE(points.rays[1].joined);
  EXPECT_FALSE(points.rays[2].joined);
}

TEST(LevelScan, UpsideDownLaserSeesTheMirroredBearings) {
  LevelScan level_scan(TPose3D(0.0, 0.0, 0.3, 0.0, 0.0, kPi), {});
  const ScanPoints points = level_scan.points(four_beams({1.0f, 2.0f, kUnmeasured}));
  ASSERT_EQ(points.rays.size(), 2u);
  expect_near(points.hits[0], 0.0, 1.0);
  expect_near(points.rays[0].end, 2.0, 0.0);  // rays stay counter-clockwise
  EXPECT_TRUE(points.rays[0].joined);
  EXPECT_FALSE(points.rays[1].joined);
}

TEST(LevelScan, MoreThanOneTurnIsCut) {
  LevelScan level_scan(TPose3D(), {});
  EXPECT_EQ(level_scan.points(four_beams({1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f})).hits.size(), 4u);
}

TEST(LevelScan, DeskewedSweepEqualsAScanAtRest) {
  // A robot that turns by 6 deg and drives 20 mm while the laser sweeps a room.
  const robot::RobotModel model;
  const slam_test::World world = slam_test::furnished_room();
  Rng none(1, "none");
  const TPose2D T_ref_first{-0.01, 0.0, deg_to_rad(-3.0)};
  const TPose2D T_ref_last{0.01, 0.0, deg_to_rad(3.0)};
  robot::LaserScan skewed = slam_test::scan_at(world, TPose2D(), model, Stamp{0}, 0.0, none);
  const TPose2D T_base_laser{model.T_base_laser.x, model.T_base_laser.y, 0.0};
  for (std::size_t beam = 0; beam < skewed.ranges.size(); ++beam) {
    const double u = static_cast<double>(beam) / static_cast<double>(skewed.ranges.size() - 1);
    const TPose2D T_world_laser = interpolate(T_ref_first, T_ref_last, u) + T_base_laser;
    const double range =
        slam_test::cast(world, {T_world_laser.x, T_world_laser.y}, T_world_laser.phi + skewed.bearing(beam));
    skewed.ranges[beam] = range <= 4.0 ? static_cast<float>(range) : kMiss;
  }
  LevelScan level_scan(model.T_base_laser, {});
  const auto distance_to_walls = [&](const ScanPoints& points) {
    double worst = 0.0;
    for (const TPoint2D& p : points.hits) {
      double nearest = 1e9;
      for (const slam_test::Segment& s : world) {
        const double dx = s.b.x - s.a.x;
        const double dy = s.b.y - s.a.y;
        const double u = std::clamp(((p.x - s.a.x) * dx + (p.y - s.a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
        nearest = std::min(nearest, std::hypot(p.x - s.a.x - u * dx, p.y - s.a.y - u * dy));
      }
      worst = std::max(worst, nearest);
    }
    return worst;
  };
  const SweepMotion motion{T_ref_first, T_ref_last};
  EXPECT_LT(distance_to_walls(level_scan.points(skewed, &motion)), 1e-5);
  EXPECT_GT(distance_to_walls(level_scan.points(skewed)), 0.03);
}

}  // namespace
}  // namespace rubble::slam
