#include "slam/scan/surface.h"

#include <gtest/gtest.h>

#include "slam/scan/level_scan.h"
#include "tests/support/slam_world.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPose2D;

ScanPoints scan_of(const slam_test::World& world, const TPose2D& T_world_base, double sigma, std::uint64_t seed) {
  const robot::RobotModel model;
  Rng noise(seed, "scan");
  LevelScan level_scan(model.T_base_laser, {});
  return level_scan.points(slam_test::scan_at(world, T_world_base, model, Stamp{0}, sigma, noise));
}

TEST(Surface, EveryReturnBelongsToOnePoint) {
  const ScanPoints scan = scan_of(slam_test::furnished_room(), {}, 0.01, 1);
  const Surface surface = surface_of(scan, {});
  std::size_t next = 0;
  for (const SurfacePoint& point : surface.points) {
    EXPECT_EQ(point.first_hit, next);
    next += point.hits;
  }
  EXPECT_EQ(next, scan.hits.size());
  EXPECT_LT(surface.points.size(), scan.hits.size() / 2);
  EXPECT_EQ(hits_of(surface, scan), scan.hits);
}

TEST(Surface, PointsOfAStraightWallLieOnIt) {
  slam_test::World wall;
  wall.push_back({{-20.0, 1.0}, {20.0, 1.0}});
  for (const SurfacePoint& point : surface_of(scan_of(wall, {}, 0.0, 1), {}).points) EXPECT_NEAR(point.p.y, 1.0, 1e-5);
}

TEST(Surface, DepthJumpsEndASurface) {
  slam_test::World world;
  world.push_back({{1.0, -3.0}, {1.0, 0.0}});
  world.push_back({{2.0, 0.0}, {2.0, 3.0}});
  const Surface surface = surface_of(scan_of(world, {}, 0.0, 1), {});
  int ends = 0;
  for (std::size_t i = 0; i + 1 < surface.points.size(); ++i) {
    if (surface.points[i].joined) continue;
    ++ends;
    EXPECT_LT(surface.points[i].p.x, 1.5);
    EXPECT_GT(surface.points[i + 1].p.x, 1.5);
  }
  EXPECT_EQ(ends, 1);
}

TEST(SurfaceCoverage, ScanCoversItselfButForItsRims) {
  const ScanPoints scan = scan_of(slam_test::furnished_room(), {}, 0.0, 1);
  const Surface surface = surface_of(scan, {});
  const Surface part = covered_part(surface, SurfaceCoverage(surface), TPose2D(), 0.1);
  EXPECT_GT(part.points.size(), surface.points.size() * 2 / 3);
  EXPECT_LT(part.points.size(), surface.points.size());
}

TEST(SurfaceCoverage, WhatComesIntoRangeIsNotCovered) {
  slam_test::World corridor;
  corridor.push_back({{-20.0, -0.6}, {20.0, -0.6}});
  corridor.push_back({{20.0, 0.6}, {-20.0, 0.6}});
  const Surface last = surface_of(scan_of(corridor, {}, 0.0, 1), {});
  const TPose2D T_last_now{0.3, 0.0, 0.0};
  const Surface now = surface_of(scan_of(corridor, T_last_now, 0.0, 2), {});
  double farthest_last = 0.0;
  for (const SurfacePoint& point : last.points) farthest_last = std::max(farthest_last, point.p.x);
  const Surface part = covered_part(now, SurfaceCoverage(last), T_last_now, 0.1);
  EXPECT_GT(part.points.size(), 40u);
  for (const SurfacePoint& point : part.points) EXPECT_LT(T_last_now.composePoint(point.p).x, farthest_last);
  double farthest_now = 0.0;
  for (const SurfacePoint& point : now.points)
    farthest_now = std::max(farthest_now, T_last_now.composePoint(point.p).x);
  EXPECT_GT(farthest_now, farthest_last);
}

TEST(SettledPart, LeavesOutWhatMayHaveComeIntoSightOnlyNow) {
  slam_test::World corridor;
  corridor.push_back({{-20.0, -0.6}, {20.0, -0.6}});
  corridor.push_back({{20.0, 0.6}, {-20.0, 0.6}});
  const Surface now = surface_of(scan_of(corridor, {}, 0.0, 2), {});
  double farthest = 0.0;
  for (const SurfacePoint& point : now.points) farthest = std::max(farthest, point.p.x);
  const Surface part = settled_part(now, 0.3);
  EXPECT_GT(part.points.size(), now.points.size() * 3 / 4);
  for (const SurfacePoint& point : part.points) EXPECT_LE(point.p.x, farthest - 0.3);
  EXPECT_EQ(settled_part(now, 0.0).points.size(), now.points.size());
}

TEST(SettledPart, KeepsTheEndOfAWallThatDoesNotGoOn) {
  slam_test::World world;
  world.push_back({{1.0, -8.0}, {1.0, 0.0}});  // ends in front of ...
  world.push_back({{2.0, 8.0}, {2.0, -8.0}});  // ... this one, which it hides in part
  const Surface now = surface_of(scan_of(world, {}, 0.0, 1), {});
  double near_end = -10.0;
  double far_begin = 10.0;
  for (const SurfacePoint& point : settled_part(now, 0.3).points) {
    if (point.p.x < 1.5) near_end = std::max(near_end, point.p.y);
    if (point.p.x > 1.5) far_begin = std::min(far_begin, point.p.y);
  }
  EXPECT_GT(near_end, -0.05);
  EXPECT_GT(far_begin, 0.3);
  EXPECT_LT(far_begin, 0.4);
}

TEST(SurfaceCoverage, NothingCoversNothing) {
  EXPECT_FALSE(SurfaceCoverage().covers({1.0, 0.0}, 0.0));
  EXPECT_FALSE(SurfaceCoverage(Surface{}).covers({1.0, 0.0}, 0.0));
}

}  // namespace
}  // namespace rubble::slam
