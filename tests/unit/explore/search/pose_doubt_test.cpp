#include "explore/search/pose_doubt.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angle.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPose2D;

PoseCovariance covariance_of(double sigma, double sigma_heading) {
  PoseCovariance covariance;
  covariance(0, 0) = covariance(1, 1) = sigma * sigma;
  covariance(2, 2) = sigma_heading * sigma_heading;
  return covariance;
}

/// The covariance that a heading known to `sigma` at the origin leaves at a place so far away.
PoseCovariance swung(double sigma, const TPose2D& there) {
  PoseCovariance covariance;
  covariance(0, 0) = sigma * sigma * there.y * there.y;
  covariance(1, 1) = sigma * sigma * there.x * there.x;
  covariance(0, 1) = covariance(1, 0) = -sigma * sigma * there.x * there.y;
  covariance(0, 2) = covariance(2, 0) = -sigma * sigma * there.y;
  covariance(1, 2) = covariance(2, 1) = sigma * sigma * there.x;
  covariance(2, 2) = sigma * sigma;
  return covariance;
}

TEST(PoseDoubt, AMapThatStandsAskewAsAWholeIsNoDoubt) {
  PoseDoubt doubt;
  doubt.update({}, swung(deg_to_rad(4.0), {}), 0.02);
  for (double way = 0.0; way < 20.0; way += 0.4 * 0.02) {
    const TPose2D pose{way, 0.3 * way, 0.0};
    doubt.update(pose, swung(deg_to_rad(4.0), pose), 0.02);
    ASSERT_FALSE(doubt.unsure()) << way << " m away, where the position alone is off by " << 0.07 * way << " m";
  }
}

TEST(PoseDoubt, WhatEveryWayCostsIsNoDoubtAndAJumpIsOne) {
  PoseDoubt doubt;
  double variance = 0.0;
  for (int i = 0; i < 20000; ++i) {  // 400 s: to 0.6 m
    variance += 0.36 / 20000;
    doubt.update({0.001 * i, 0.0, 0.0}, covariance_of(std::sqrt(0.5 * variance), 0.0), 0.02);
    ASSERT_FALSE(doubt.unsure());
  }
  const TPose2D lost{20.0, 0.0, 0.0};
  for (int i = 0; i < 1000; ++i) {
    doubt.update(lost, covariance_of(0.9, 0.0), 0.02);
    ASSERT_TRUE(doubt.unsure()) << "20 s";
  }
  doubt.update(lost, covariance_of(0.3, 0.0), 0.02);
  EXPECT_FALSE(doubt.unsure());
  doubt.update(lost, covariance_of(0.31, 0.0), 0.02);
  EXPECT_FALSE(doubt.unsure());
}

TEST(PoseDoubt, AMapperThatDoesNotEstimateItIsNeverDoubted) {
  PoseDoubt doubt;
  for (int i = 0; i < 1000; ++i) {
    doubt.update({0.01 * i, 0.0, 0.0}, {}, 0.02);
    ASSERT_FALSE(doubt.unsure());
  }
}

}  // namespace
}  // namespace rubble::explore
