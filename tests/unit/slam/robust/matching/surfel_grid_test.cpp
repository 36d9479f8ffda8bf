#include "slam/robust/matching/surfel_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/slam_surfels.h"

namespace rubble::slam {
namespace {

constexpr float kSameSide = 0.9F;

double d2(const Surfel& q, float x, float y) {
  const double dx = static_cast<double>(q.x - x);
  const double dy = static_cast<double>(q.y - y);
  return dx * dx + dy * dy;
}

/// The closest surfel that looks the asked way, by trying them all; infinite when none lies within `radius`.
double nearest_by_trying(const SurfelGrid& grid, const OrientedPoint& p, double radius) {
  double best = radius * radius;
  bool found = false;
  for (const Surfel& q : grid.surfels()) {
    if (p.has_normal() && q.nx * p.nx + q.ny * p.ny <= kSameSide) continue;
    if (d2(q, p.x, p.y) >= best) continue;
    best = d2(q, p.x, p.y);
    found = true;
  }
  return found ? std::sqrt(best) : std::numeric_limits<double>::infinity();
}

/// Cells are looked at in a block of whole cells: within so much of a point all are.
double surely_seen(double cell, double radius) { return std::ceil(radius / cell - 0.5) * cell; }

/// What is seen from one end of a valley to the other, in cells of 2 cm: far more than can be numbered.
TEST(SurfelGrid, TooManyCellsAreTakenLarger) {
  SurfelGrid grid;
  grid.begin(0.02, {-2000.0, -2000.0}, {2000.0, 2000.0});
  std::vector<OrientedPoint> points;
  for (int k = 0; k <= 40; ++k) {
    const auto along = static_cast<float>(k * 100 - 2000);
    points.push_back({along, -along, 1.0F, 0.0F});
    points.push_back({along, 0.5F * along, 0.0F, 1.0F});
  }
  grid.add(points, {});
  grid.finish();
  for (const OrientedPoint& p : points) {
    const Surfel* found = grid.nearest(p.x, p.y, p.nx, p.ny, 0.3F);
    ASSERT_NE(found, nullptr) << p.x << ", " << p.y;
    EXPECT_LT(std::sqrt(d2(*found, p.x, p.y)), 0.01);
  }
}

TEST(SurfelGrid, NearestIsTheNearestOfAll) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "surfels");
    const double cell = rng.uniform(0.05, 0.2);
    const SurfelGrid grid = slam_test::surfel_grid(slam_test::random_points(rng, 400, 2.0), cell);
    for (int k = 0; k < 300; ++k) {
      OrientedPoint p = slam_test::random_points(rng, 1, 2.0).front();
      if (k % 3 == 0) p.nx = p.ny = 0.0F;
      const double radius = rng.uniform(0.5 * cell, 0.5);
      const Surfel* found = grid.nearest(p.x, p.y, p.nx, p.ny, static_cast<float>(radius));
      const double best = nearest_by_trying(grid, p, radius);
      if (found == nullptr) {
        EXPECT_GE(best, surely_seen(cell, radius) - 1e-5);
        continue;
      }
      const double got = std::sqrt(d2(*found, p.x, p.y));
      EXPECT_LE(got, radius + 1e-6);
      EXPECT_TRUE(!p.has_normal() || found->nx * p.nx + found->ny * p.ny > kSameSide);
      if (best < surely_seen(cell, radius) - 1e-5)
        EXPECT_NEAR(got, best, 1e-6);
      else
        EXPECT_GE(got, best - 1e-6);
    }
  }
}

TEST(SurfelGrid, NothingIsFoundFarOutside) {
  Rng rng(1, "surfels");
  const SurfelGrid grid = slam_test::surfel_grid(slam_test::random_points(rng, 50, 1.0), 0.1);
  for (const float far : {-1e6F, -30.0F, 30.0F, 1e6F}) {
    EXPECT_EQ(grid.nearest(far, 0.0F, 0.0F, 0.0F, 0.3F), nullptr);
    EXPECT_EQ(grid.nearest(0.0F, far, 0.0F, 0.0F, 0.3F), nullptr);
  }
}

TEST(SurfelGrid, ASurfelIsTheMeanOfItsPoints) {
  const std::vector<OrientedPoint> points{
      {0.01F, 0.02F, 0.0F, 1.0F}, {0.05F, 0.03F, 0.0F, 1.0F}, {0.09F, 0.01F, 0.0F, 1.0F}};
  SurfelGrid grid;
  grid.begin(0.1, {0.0, 0.0}, {0.1, 0.1});
  grid.add(points, {});
  grid.finish();
  ASSERT_EQ(grid.surfels().size(), 1u);
  EXPECT_NEAR(grid.surfels()[0].x, 0.05, 1e-6);
  EXPECT_NEAR(grid.surfels()[0].y, 0.02, 1e-6);
  EXPECT_NEAR(grid.surfels()[0].ny, 1.0, 1e-6);
}

TEST(SurfelGrid, BothSidesOfAThinWallStayApart) {
  SurfelGrid grid;
  grid.begin(0.1, {0.0, 0.0}, {0.1, 0.1});
  grid.add({{0.05F, 0.03F, 0.0F, -1.0F}, {0.05F, 0.07F, 0.0F, 1.0F}}, {});
  grid.finish();
  ASSERT_EQ(grid.surfels().size(), 2u);
  const Surfel* below = grid.nearest(0.05F, 0.05F, 0.0F, -1.0F, 0.1F);
  const Surfel* above = grid.nearest(0.05F, 0.05F, 0.0F, 1.0F, 0.1F);
  ASSERT_NE(below, nullptr);
  ASSERT_NE(above, nullptr);
  EXPECT_NEAR(below->y, 0.03, 1e-6);
  EXPECT_NEAR(above->y, 0.07, 1e-6);
}

TEST(SurfelGrid, PointsAreMovedAndThoseWithoutNormalSayNothing) {
  SurfelGrid grid;
  grid.begin(0.1, {-3.0, -3.0}, {3.0, 3.0});
  grid.add({{1.0F, 0.0F, 1.0F, 0.0F}, {0.5F, 0.0F, 0.0F, 0.0F}}, {0.5, 1.0, 0.5 * kPi});
  grid.finish();
  ASSERT_EQ(grid.surfels().size(), 1u);
  EXPECT_NEAR(grid.surfels()[0].x, 0.5, 1e-6);
  EXPECT_NEAR(grid.surfels()[0].y, 2.0, 1e-6);
  EXPECT_NEAR(grid.surfels()[0].nx, 0.0, 1e-6);
  EXPECT_NEAR(grid.surfels()[0].ny, 1.0, 1e-6);
}

}  // namespace
}  // namespace rubble::slam
