#include "scoring/trajectory/trajectory_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angle.h"
#include "base/rng.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

Trajectory circle(int count, double period) {
  Trajectory out;
  for (int i = 0; i < count; ++i) {
    const double a = 2.0 * kPi * i / count;
    out.push_back({Stamp::from_seconds(i * period), TPose2D(3.0 * std::cos(a), 3.0 * std::sin(a), a + kPi / 2)});
  }
  return out;
}

Trajectory moved(Trajectory trajectory, const TPose2D& T) {
  for (StampedPose& stamped : trajectory) stamped.pose = T + stamped.pose;
  return trajectory;
}

TEST(TrajectoryError, ARigidMotionOfTheWholeRunIsNoError) {
  const Trajectory truth = circle(100, 0.1);
  const TrajectoryError error = trajectory_error(moved(truth, TPose2D(4.0, -7.0, 2.1)), truth);
  EXPECT_EQ(error.matched, 100u);
  EXPECT_NEAR(error.ate_first_m, 0.0, 1e-9);
  EXPECT_NEAR(error.ate_aligned_m, 0.0, 1e-9);
}

TEST(TrajectoryError, FirstPoseAlignmentKeepsAConstantOffsetOfTheOthers) {
  // All but the first pose are 0.4 m off: RMSE = 0.4 sqrt((n - 1) / n).
  Trajectory truth;
  Trajectory estimate;
  for (int i = 0; i < 10; ++i) {
    truth.push_back({Stamp::from_seconds(i), TPose2D(i, 0.0, 0.0)});
    estimate.push_back({Stamp::from_seconds(i), TPose2D(i, i == 0 ? 0.0 : 0.4, 0.0)});
  }
  EXPECT_NEAR(trajectory_error(estimate, truth).ate_first_m, 0.4 * std::sqrt(0.9), 1e-12);
}

TEST(TrajectoryError, AHeadingErrorAtTheStartSwingsTheFirstPoseAlignmentOnly) {
  // A straight line of 10 m whose first heading is off by 0.1 rad: errors 2 sin(0.05) r along the line.
  Trajectory truth;
  Trajectory estimate;
  double sum = 0.0;
  for (int i = 0; i <= 10; ++i) {
    truth.push_back({Stamp::from_seconds(i), TPose2D(i, 0.0, 0.0)});
    estimate.push_back({Stamp::from_seconds(i), TPose2D(i, 0.0, i == 0 ? 0.1 : 0.0)});
    sum += std::pow(2.0 * std::sin(0.05) * i, 2.0);
  }
  const TrajectoryError error = trajectory_error(estimate, truth);
  EXPECT_NEAR(error.ate_first_m, std::sqrt(sum / 11.0), 1e-12);
  EXPECT_NEAR(error.ate_aligned_m, 0.0, 1e-9);
}

TEST(TrajectoryError, ASizeIsToldApartFromAllElse) {
  const Trajectory truth = circle(100, 0.1);
  for (const double size : {0.5, 0.9975, 1.0, 1.0025, 3.0}) {
    Trajectory estimate = moved(truth, TPose2D(4.0, -7.0, 2.1));
    for (StampedPose& stamped : estimate)
      stamped.pose = {size * stamped.pose.x, size * stamped.pose.y, stamped.pose.phi};
    const TrajectoryError error = trajectory_error(estimate, truth);
    EXPECT_NEAR(error.scale, size, 1e-9);
    EXPECT_NEAR(error.ate_scaled_m, 0.0, 1e-9);
    // A circle of 3 m that is too large lies so far outside the true one.
    EXPECT_NEAR(error.ate_aligned_m, 3.0 * std::abs(size - 1.0), 1e-9);
  }
}

TEST(TrajectoryError, NoSizeFitsBetterThanTheOneTold) {
  const Trajectory truth = circle(60, 0.1);
  Trajectory estimate = moved(truth, TPose2D(1.0, 2.0, -0.5));
  Rng noise(7, "noise");
  for (StampedPose& stamped : estimate) {
    stamped.pose.x = 1.1 * stamped.pose.x + noise.gaussian(0.2);
    stamped.pose.y = 1.1 * stamped.pose.y + noise.gaussian(0.2);
  }
  const TrajectoryError best = trajectory_error(estimate, truth);
  EXPECT_LT(best.ate_scaled_m, best.ate_aligned_m);
  for (double other = 0.8; other < 1.4; other += 0.01) {
    Trajectory shrunk = estimate;
    for (StampedPose& stamped : shrunk)
      stamped.pose = {stamped.pose.x / other, stamped.pose.y / other, stamped.pose.phi};
    EXPECT_GE(trajectory_error(shrunk, truth).ate_aligned_m, best.ate_scaled_m - 1e-12) << other;
  }
}

TEST(TrajectoryError, ARobotThatStoodHasNoSize) {
  Trajectory stood;
  for (int i = 0; i < 5; ++i) stood.push_back({Stamp::from_seconds(i), TPose2D(1.0, 2.0, 0.3)});
  EXPECT_EQ(trajectory_error(stood, stood).scale, 1.0);
  Rng noise(8, "noise");
  Trajectory jitters = stood;
  for (StampedPose& stamped : jitters) stamped.pose.x += noise.gaussian(0.01);
  EXPECT_EQ(trajectory_error(jitters, stood).scale, 1.0);
  EXPECT_EQ(trajectory_error(stood, jitters).scale, 1.0);
}

TEST(TrajectoryError, NoRigidTransformBeatsTheBestOne) {
  const Trajectory truth = circle(60, 0.1);
  Trajectory estimate = moved(truth, TPose2D(1.0, 2.0, -0.5));
  Rng noise(5, "noise");
  for (StampedPose& stamped : estimate) {
    stamped.pose.x += noise.gaussian(0.2);
    stamped.pose.y += noise.gaussian(0.2);
  }
  const double best = trajectory_error(estimate, truth).ate_aligned_m;
  Rng tries(6, "tries");
  for (int i = 0; i < 200; ++i) {
    const double x = tries.uniform(-3.0, 3.0);
    const double y = tries.uniform(-3.0, 3.0);
    const double phi = tries.uniform(-kPi, kPi);
    double sum = 0.0;
    for (std::size_t k = 0; k < truth.size(); ++k) {
      const TPoint2D p = TPose2D(x, y, phi).composePoint(TPoint2D(estimate[k].pose.x, estimate[k].pose.y));
      sum += std::pow(p.x - truth[k].pose.x, 2.0) + std::pow(p.y - truth[k].pose.y, 2.0);
    }
    EXPECT_GE(std::sqrt(sum / 60.0), best - 1e-9);
  }
}

TEST(TrajectoryError, TruthIsInterpolatedAtTheEstimatesStamps) {
  const Trajectory truth = {{Stamp::from_seconds(0), TPose2D(0, 0, 0)}, {Stamp::from_seconds(10), TPose2D(10, 0, 0)}};
  const Trajectory estimate = {{Stamp::from_seconds(-1), TPose2D(-5, 3, 0)},
                               {Stamp::from_seconds(0), TPose2D(0, 0, 0)},
                               {Stamp::from_seconds(2.5), TPose2D(2.5, 0, 0)},
                               {Stamp::from_seconds(7), TPose2D(7, 0, 0)}};
  const TrajectoryError error = trajectory_error(estimate, truth);
  EXPECT_EQ(error.matched, 3u);
  EXPECT_NEAR(error.ate_first_m, 0.0, 1e-12);
}

TEST(TrajectoryError, RunsThatShareNoTimeMatchNothing) {
  const Trajectory truth = circle(10, 0.1);
  Trajectory late = truth;
  for (StampedPose& stamped : late) stamped.stamp = stamped.stamp + 100.0;
  EXPECT_EQ(trajectory_error(late, truth).matched, 0u);
  EXPECT_EQ(trajectory_error({}, truth).matched, 0u);
}

}  // namespace
}  // namespace rubble::scoring
