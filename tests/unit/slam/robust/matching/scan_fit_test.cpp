#include "slam/robust/matching/scan_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <string>

#include "base/planar.h"
#include "tests/support/slam_surfels.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/// Four walls that do not touch, so that each surfel lies on one of them.
slam_test::World walls() {
  return {{{-1.8, -1.5}, {2.3, -1.5}},
          {{2.6, -1.2}, {2.6, 1.5}},
          {{2.3, 1.8}, {-1.8, 1.8}},
          {{-2.1, 1.5}, {-2.1, -1.2}},
          {{0.5, 0.2}, {1.1, 0.8}}};
}

SurfelGrid grid_of(const slam_test::World& world) {
  return slam_test::surfel_grid(slam_test::surface_points(world, 0.02), 0.10);
}

/// Sum of the squared distances of points from the lines of their walls, over 2 sigma^2.
double half_chi2(const std::vector<OrientedPoint>& points, const slam_test::World& world, const TPose2D& T,
                 double sigma) {
  const double c = std::cos(T.phi);
  const double s = std::sin(T.phi);
  double sum = 0.0;
  for (const OrientedPoint& p : points) {
    const double px = static_cast<double>(p.x), py = static_cast<double>(p.y);
    const TPoint2D at(T.x + c * px - s * py, T.y + s * px + c * py);
    double nearest = 1e9;
    for (const slam_test::Segment& wall : world) {
      const TPoint2D along = wall.b - wall.a;
      const double t =
          ((at.x - wall.a.x) * along.x + (at.y - wall.a.y) * along.y) / (along.x * along.x + along.y * along.y);
      const TPoint2D foot = wall.a + along * std::min(1.0, std::max(0.0, t));
      nearest = std::min(nearest, distance(at, foot));
    }
    sum += nearest * nearest;
  }
  return 0.5 * sum / (sigma * sigma);
}

/// Second derivatives of f about T by central differences.
Eigen::Matrix3d numerical_hessian(const std::function<double(const TPose2D&)>& f, const TPose2D& T) {
  const double h = 1e-3;
  const auto at = [&](int i, double di, int j, double dj) {
    double d[3] = {0, 0, 0};
    d[i] += di;
    d[j] += dj;
    return f({T.x + d[0], T.y + d[1], T.phi + d[2]});
  };
  Eigen::Matrix3d H;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      H(i, j) = (at(i, h, j, h) - at(i, h, j, -h) - at(i, -h, j, h) + at(i, -h, j, -h)) / (4.0 * h * h);
  return H;
}

PosePrior nothing_known(const TPose2D& pose) {
  PosePrior prior;
  prior.pose = pose;
  return prior;
}

TEST(ScanFit, FindsThePoseOfPointsWithoutNoise) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "fit");
    const TPose2D truth{rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0), rng.uniform(-kPi, kPi)};
    const auto points = slam_test::seen_from(truth, slam_test::surface_points(walls(), 0.08));
    const TPose2D start{truth.x + rng.uniform(-0.1, 0.1), truth.y + rng.uniform(-0.1, 0.1),
                        truth.phi + rng.uniform(-0.08, 0.08)};
    const ScanFit fit = fit_scan(grid_of(walls()), points, start, nothing_known(start), {});
    EXPECT_NEAR(fit.pose.x, truth.x, 2e-3);
    EXPECT_NEAR(fit.pose.y, truth.y, 2e-3);
    EXPECT_NEAR(wrap_angle(fit.pose.phi - truth.phi), 0.0, 1e-3);
    EXPECT_GT(fit.inliers, 0.98);
    EXPECT_TRUE(well_conditioned(fit));
  }
}

TEST(ScanFit, InformationIsTheSecondDerivativeOfTheSquaredErrors) {
  const ScanFitConfig config;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "fit");
    const TPose2D truth{rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0), rng.uniform(-kPi, kPi)};
    std::vector<OrientedPoint> inner;  // ends of walls have no line to be measured against
    for (const OrientedPoint& p : slam_test::surface_points(walls(), 0.07)) {
      bool at_end = false;
      for (const slam_test::Segment& wall : walls())
        for (const TPoint2D& end : {wall.a, wall.b})
          at_end = at_end || distance(end, {static_cast<double>(p.x), static_cast<double>(p.y)}) < 0.12;
      if (!at_end) inner.push_back(p);
    }
    const auto points = slam_test::seen_from(truth, inner);
    const ScanFit fit = fit_scan(grid_of(walls()), points, truth, nothing_known(truth), config);
    const Eigen::Matrix3d expected =
        numerical_hessian([&](const TPose2D& T) { return half_chi2(points, walls(), T, config.sigma); }, fit.pose);
    EXPECT_LT((fit.information - expected).norm(), 0.01 * expected.norm()) << fit.information << "\n\n" << expected;
  }
}

TEST(ScanFit, PosesScatterAsTheInformationSays) {
  ScanFitConfig config;
  config.iterations = 30;
  const TPose2D truth{0.3, -0.2, 0.4};
  const SurfelGrid grid = grid_of(walls());
  const auto ideal = slam_test::seen_from(truth, slam_test::surface_points(walls(), 0.08));
  double sum = 0.0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    Rng rng(static_cast<std::uint64_t>(run + 1), "noise");
    std::vector<OrientedPoint> noisy = ideal;
    for (OrientedPoint& p : noisy) {
      const auto e = static_cast<float>(rng.gaussian(config.sigma));
      p.x += e * p.nx;
      p.y += e * p.ny;
    }
    const ScanFit fit = fit_scan(grid, noisy, truth, nothing_known(truth), config);
    const Eigen::Vector3d off(fit.pose.x - truth.x, fit.pose.y - truth.y, wrap_angle(fit.pose.phi - truth.phi));
    sum += off.dot(fit.information * off);
  }
  // Three degrees of freedom; the Cauchy weights give away some information.
  EXPECT_GT(sum / kRuns, 2.0);
  EXPECT_LT(sum / kRuns, 4.0);
}

TEST(ScanFit, AlongACorridorThePriorAloneDecides) {
  const slam_test::World corridor{{{-5.0, -0.6}, {5.0, -0.6}}, {{5.0, 0.6}, {-5.0, 0.6}}};
  const SurfelGrid grid = grid_of(corridor);
  std::vector<OrientedPoint> near;
  for (const OrientedPoint& p : slam_test::surface_points(corridor, 0.08))
    if (std::abs(p.x) < 2.0F) near.push_back(p);
  const auto points = slam_test::seen_from({0.0, 0.1, 0.05}, near);
  const TPose2D expected{0.07, 0.05, 0.0};
  PosePrior prior{expected, Eigen::Vector3d(100.0, 100.0, 10.0).asDiagonal()};
  const ScanFit fit = fit_scan(grid, points, expected, prior, {});
  EXPECT_NEAR(fit.pose.x, expected.x, 2e-3);
  EXPECT_NEAR(fit.pose.y, 0.1, 2e-3);
  EXPECT_NEAR(fit.pose.phi, 0.05, 2e-3);
  const double along = fit.information(0, 0);
  EXPECT_LT(along, 0.02 * fit.information(1, 1));
  EXPECT_FALSE(well_conditioned(fit));
}

/// Where another wall meets it, neighbours on both give a point of the corner a normal between; one such surfel took
/// 0.3 m of a lane, scan by scan, and the map then closed a loop to the next pallet.
TEST(ScanFit, InACorridorACornersSlantedNormalHoldsNothingBack) {
  const slam_test::World corridor{{{-5.0, -0.6}, {5.0, -0.6}}, {{5.0, 0.6}, {-5.0, 0.6}}};
  std::vector<OrientedPoint> mapped = slam_test::surface_points(corridor, 0.02);
  const auto aslant = static_cast<float>(std::sqrt(0.5));
  for (const float x : {1.0F, 1.5F, 2.0F}) mapped.push_back({x, 0.57F, -aslant, -aslant});
  const SurfelGrid grid = slam_test::surfel_grid(mapped, 0.10);
  std::vector<OrientedPoint> near;
  for (const OrientedPoint& p : slam_test::surface_points(corridor, 0.08))
    if (std::abs(p.x) < 3.0F) near.push_back(p);
  const auto points = slam_test::seen_from({0.0, 0.0, 0.0}, near);
  for (const double way : {0.02, 0.04, 0.06}) {
    const TPose2D expected{way, 0.0, 0.0};
    PosePrior prior{expected, Eigen::Vector3d(3600.0, 3600.0, 2500.0).asDiagonal()};  // of a step of 4 cm
    EXPECT_NEAR(fit_scan(grid, points, expected, prior, {}).pose.x, way, 1e-3);
  }
}

TEST(ScanFit, AStrongPriorHoldsThePose) {
  const auto points = slam_test::seen_from({0.1, 0.0, 0.0}, slam_test::surface_points(walls(), 0.08));
  const TPose2D held{0.02, 0.03, 0.01};
  const PosePrior prior{held, 1e12 * Eigen::Matrix3d::Identity()};
  const ScanFit fit = fit_scan(grid_of(walls()), points, held, prior, {});
  EXPECT_NEAR(fit.pose.x, held.x, 1e-5);
  EXPECT_NEAR(fit.pose.y, held.y, 1e-5);
  EXPECT_NEAR(fit.pose.phi, held.phi, 1e-5);
}

TEST(ScanFit, PriorIsMeasuredAlongItsOwnAxes) {
  // Turned a quarter left, the prior's own x axis is the map's y axis: weak there, strong along its own y.
  const slam_test::World corridor{{{-5.0, -0.6}, {5.0, -0.6}}, {{5.0, 0.6}, {-5.0, 0.6}}};
  std::vector<OrientedPoint> near;
  for (const OrientedPoint& p : slam_test::surface_points(corridor, 0.08))
    if (std::abs(p.x) < 2.0F) near.push_back(p);
  const TPose2D truth{0.0, 0.1, 0.5 * kPi};
  const auto points = slam_test::seen_from(truth, near);
  const TPose2D expected{0.0, 0.0, 0.5 * kPi};
  const auto fitted = [&](double ahead, double aside) {
    const PosePrior prior{expected, Eigen::Vector3d(ahead, aside, 10.0).asDiagonal()};
    return fit_scan(grid_of(corridor), points, expected, prior, {}).pose.y;
  };
  EXPECT_NEAR(fitted(1e-3, 1e9), 0.1, 3e-3);
  EXPECT_NEAR(fitted(1e9, 1e-3), 0.0, 3e-3);
}

TEST(ScanFit, WithoutPartnersThePoseStays) {
  const TPose2D start{40.0, 3.0, 0.5};
  const ScanFit fit =
      fit_scan(grid_of(walls()), slam_test::surface_points(walls(), 0.1), start, nothing_known(start), {});
  EXPECT_EQ(fit.pose, start);
  EXPECT_EQ(fit.paired, 0);
  EXPECT_EQ(fit.inliers, 0.0);
  const ScanFit none = fit_scan(grid_of(walls()), {}, start, nothing_known(start), {});
  EXPECT_EQ(none.pose, start);
}

}  // namespace
}  // namespace rubble::slam
