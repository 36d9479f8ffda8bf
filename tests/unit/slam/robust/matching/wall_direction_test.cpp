#include "slam/robust/matching/wall_direction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angle.h"
#include "base/rng.h"
#include "tests/support/slam_world.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

Cloud seen_from(const slam_test::World& world, const TPose2D& T_world_base, double range_sigma, std::uint64_t seed) {
  const robot::RobotModel model;
  Rng noise(seed, "scan");
  LevelScan level(model.T_base_laser, {});
  return cloud_of(level.points(slam_test::scan_at(world, T_world_base, model, Stamp{0}, range_sigma, noise)), {});
}

/// Points on a line, `spacing` apart, as a scan has them.
void add_line(Cloud& cloud, const TPoint2D& from, const TPoint2D& to, double spacing) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const int pieces = static_cast<int>(length / spacing);
  for (int k = 0; k <= pieces; ++k) {
    const double u = static_cast<double>(k) / pieces;
    cloud.points.push_back({static_cast<float>(from.x + u * (to.x - from.x)),
                            static_cast<float>(from.y + u * (to.y - from.y)), 0.0F, 0.0F});
  }
}

TEST(WrapQuarter, IsTheSameForAllThatStandAlongOrAcross) {
  Rng rng(5, "angles");
  for (int k = 0; k < 200; ++k) {
    const double angle = rng.uniform(-10.0, 10.0);
    const double wrapped = wrap_quarter(angle);
    EXPECT_GT(wrapped, -0.25 * kPi);
    EXPECT_LE(wrapped, 0.25 * kPi);
    EXPECT_NEAR(std::remainder(wrapped - angle, 0.5 * kPi), 0.0, 1e-12);
  }
}

TEST(WallDirection, OfARoomIsThatOfTheRobotAgainstIt) {
  const slam_test::World room = slam_test::furnished_room();
  for (const std::uint64_t seed : {1U, 2U, 3U})
    for (double heading = -3.0; heading < 3.0; heading += 0.37) {
      SCOPED_TRACE("heading " + std::to_string(heading) + " seed " + std::to_string(seed));
      const auto walls = wall_direction(seen_from(room, {0.3, 0.1, heading}, 0.01, seed));
      ASSERT_TRUE(walls);
      EXPECT_LT(std::abs(wrap_quarter(walls->angle + heading)), std::max(deg_to_rad(0.6), 3.0 * walls->sigma));
      EXPECT_LT(walls->sigma, deg_to_rad(1.0));
    }
}

TEST(WallDirection, TurnsWithTheRobotAndIsMirroredWithTheWorld) {
  const Cloud cloud = seen_from(slam_test::furnished_room(), {0.3, 0.1, 0.2}, 0.01, 4);
  const auto walls = wall_direction(cloud);
  ASSERT_TRUE(walls);
  Cloud turned = cloud;
  Cloud mirrored = cloud;
  const double c = std::cos(0.3);
  const double s = std::sin(0.3);
  turned.laser = {c * cloud.laser.x - s * cloud.laser.y, s * cloud.laser.x + c * cloud.laser.y};
  mirrored.laser.y = -cloud.laser.y;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const double x = static_cast<double>(cloud.points[i].x);
    const double y = static_cast<double>(cloud.points[i].y);
    turned.points[i].x = static_cast<float>(c * x - s * y);
    turned.points[i].y = static_cast<float>(s * x + c * y);
    mirrored.points[i].y = static_cast<float>(-y);
  }
  ASSERT_TRUE(wall_direction(turned));
  ASSERT_TRUE(wall_direction(mirrored));
  EXPECT_NEAR(wrap_quarter(wall_direction(turned)->angle - walls->angle - 0.3), 0.0, 1e-4);
  EXPECT_NEAR(wrap_quarter(wall_direction(mirrored)->angle + walls->angle), 0.0, 1e-4);
}

TEST(WallDirection, IsNotToldByARoundRoomNorByTooLittleWallNorByWallsThatDisagree) {
  Cloud round;
  for (int k = 0; k < 400; ++k) {
    const double phi = 2.0 * kPi * k / 400;
    round.points.push_back({static_cast<float>(2.0 * std::cos(phi)), static_cast<float>(2.0 * std::sin(phi)), 0, 0});
  }
  EXPECT_FALSE(wall_direction(round));

  Cloud little;
  add_line(little, {1.0, -0.5}, {1.0, 0.5}, 0.08);
  EXPECT_FALSE(wall_direction(little));
  add_line(little, {2.0, -0.5}, {2.0, 1.0}, 0.08);
  EXPECT_TRUE(wall_direction(little));

  Cloud divided;
  add_line(divided, {2.0, -2.0}, {2.0, 2.0}, 0.08);
  add_line(divided, {-3.0, -2.0}, {-1.0, 1.4}, 0.08);
  EXPECT_FALSE(wall_direction(divided));
  EXPECT_FALSE(wall_direction(Cloud{}));
}

}  // namespace
}  // namespace rubble::slam
