#include "slam/scan/scan_matcher.h"

#include <gtest/gtest.h>

#include "slam/scan/level_scan.h"
#include "tests/support/slam_world.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPose2D;

Surface surface_at(const slam_test::World& world, const TPose2D& T_world_base, double sigma, Rng& noise) {
  const robot::RobotModel model;
  LevelScan level_scan(model.T_base_laser, {});
  return surface_of(level_scan.points(slam_test::scan_at(world, T_world_base, model, Stamp{0}, sigma, noise)), {});
}

/// As the mapper does: only what both scans saw enters the match.
ScanMatch match(const Surface& last, const Surface& now, const TPose2D& T_last_prior) {
  ScanMatcher matcher{ScanMatcherConfig{}};
  matcher.set_last(last);
  return matcher.match(covered_part(now, SurfaceCoverage(last), T_last_prior, 0.1), T_last_prior);
}

TEST(ScanMatcher, RecoversKnownMotionsInARoom) {
  Rng noise(1, "scan");
  Rng draw(2, "motions");
  for (int k = 0; k < 50; ++k) {
    const double x = draw.uniform(-0.5, 1.0);
    const double y = draw.uniform(-0.4, 0.4);
    const TPose2D T_world_last{x, y, draw.uniform(-kPi, kPi)};
    const double forward = draw.uniform(-0.08, 0.08);
    const TPose2D motion{forward, 0.0, draw.uniform(-0.1, 0.1)};
    const double error_x = draw.gaussian(0.03);
    const double error_y = draw.gaussian(0.03);
    const TPose2D prior = motion + TPose2D{error_x, error_y, draw.gaussian(deg_to_rad(1.5))};
    const Surface last = surface_at(slam_test::furnished_room(), T_world_last, 0.01, noise);
    const Surface now = surface_at(slam_test::furnished_room(), T_world_last + motion, 0.01, noise);
    const ScanMatch result = match(last, now, prior);
    EXPECT_TRUE(result.accepted);
    const TPose2D error = result.T_last_now - motion;
    EXPECT_LT(std::hypot(error.x, error.y), 0.02) << k;
    EXPECT_LT(std::abs(rad_to_deg(wrap_angle(error.phi))), 0.6) << k;
  }
}

TEST(ScanMatcher, FeaturelessCorridorKeepsTheOdometryAlongIt) {
  slam_test::World corridor;
  slam_test::add_box(corridor, -20.0, -0.6, 20.0, 0.6);
  Rng noise(3, "scan");
  double sum = 0.0;
  for (int k = 0; k < 40; ++k) {
    const TPose2D T_world_last{0.05 * k, 0.0, 0.0};
    const TPose2D motion{0.04, 0.0, 0.0};
    const Surface last = surface_at(corridor, T_world_last, 0.01, noise);
    const Surface now = surface_at(corridor, T_world_last + motion, 0.01, noise);
    const ScanMatch result = match(last, now, motion);
    sum += result.T_last_now.x - motion.x;
    EXPECT_NEAR(result.T_last_now.y, 0.0, 0.01);
  }
  EXPECT_LT(std::abs(sum / 40.0), 0.003) << "no drag towards standing still";
}

TEST(ScanMatcher, TurningOnTheSpotIsUnbiased) {
  Rng noise(4, "scan");
  Rng draw(5, "poses");
  double sum = 0.0;
  for (int k = 0; k < 60; ++k) {
    const TPose2D T_world_last{draw.uniform(-0.5, 0.5), 0.0, 0.1 * k};
    const TPose2D motion{0.0, 0.0, deg_to_rad(4.5)};
    const ScanMatch result = match(surface_at(slam_test::furnished_room(), T_world_last, 0.01, noise),
                                   surface_at(slam_test::furnished_room(), T_world_last + motion, 0.01, noise), motion);
    sum += rad_to_deg(wrap_angle(result.T_last_now.phi - motion.phi));
  }
  EXPECT_LT(std::abs(sum / 60.0), 0.03);
}

TEST(ScanMatcher, UnrelatedScansKeepTheOdometry) {
  slam_test::World elsewhere;
  slam_test::add_box(elsewhere, -0.6, -0.5, 0.7, 0.6);
  Rng noise(6, "scan");
  ScanMatcher matcher{ScanMatcherConfig{}};
  matcher.set_last(surface_at(slam_test::furnished_room(), {}, 0.01, noise));
  const TPose2D prior{0.03, 0.0, 0.01};
  const ScanMatch result = matcher.match(surface_at(elsewhere, {}, 0.01, noise), prior);
  EXPECT_FALSE(result.accepted);
  EXPECT_EQ(result.T_last_now, prior);
}

TEST(ScanMatcher, TooFewPointsKeepTheOdometry) {
  ScanMatcher matcher{ScanMatcherConfig{}};
  const TPose2D prior{0.03, 0.0, 0.01};
  EXPECT_FALSE(matcher.match(Surface{}, prior).accepted);
  Rng noise(7, "scan");
  matcher.set_last(surface_at(slam_test::furnished_room(), {}, 0.01, noise));
  const ScanMatch result = matcher.match(Surface{}, prior);
  EXPECT_FALSE(result.accepted);
  EXPECT_EQ(result.T_last_now, prior);
}

TEST(ScanMatcher, SameInputSameBits) {
  Rng noise(8, "scan");
  const Surface last = surface_at(slam_test::furnished_room(), {}, 0.01, noise);
  const Surface now = surface_at(slam_test::furnished_room(), {0.05, 0.0, 0.05}, 0.01, noise);
  EXPECT_EQ(match(last, now, {0.03, 0.01, 0.04}).T_last_now, match(last, now, {0.03, 0.01, 0.04}).T_last_now);
}

}  // namespace
}  // namespace rubble::slam
