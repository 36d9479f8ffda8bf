#include "slam/calibration/calibration.h"

#include <gtest/gtest.h>

#include <iostream>

#include "tests/support/calibration_recording.h"

namespace rubble::slam {
namespace {

using slam_test::RecordingPlan;

constexpr std::uint64_t kSeeds[] = {1, 2, 3, 4, 5, 6};

/// A truth that differs from what it is taken for in every number.
RobotSetup planted(std::uint64_t seed) {
  Rng rng(seed, "planted");
  RobotSetup truth;
  truth.distance_scale = 1.0 + rng.gaussian(0.03);
  truth.turn_scale = 1.0 + rng.gaussian(0.06);
  truth.T_base_laser = {0.145 + rng.gaussian(0.03), rng.gaussian(0.03), rng.gaussian(deg_to_rad(4.0))};
  truth.delay = rng.gaussian(0.02);
  return truth;
}

RobotSetup taken_for() {
  RobotSetup setup;
  setup.T_base_laser = {0.145, 0.0, 0.0};
  return setup;
}

Calibration calibrated(const RecordingPlan& plan, const RobotSetup& start = taken_for()) {
  Calibrator calibrator;
  for (const robot::Inputs& tick : slam_test::calibration_recording(slam_test::furnished_room(), plan))
    calibrator.add(tick);
  return calibrator.calibrate(start, robot::AccelerometerMount::Body);
}

std::vector<double> numbers(const RobotSetup& s) {
  return {s.distance_scale, s.turn_scale, s.T_base_laser.x, s.T_base_laser.y, s.T_base_laser.phi, s.delay};
}

void expect_found(const RobotSetup& found, const RobotSetup& truth) {
  EXPECT_NEAR(found.distance_scale / truth.distance_scale, 1.0, 0.01);
  EXPECT_NEAR(found.turn_scale / truth.turn_scale, 1.0, 0.01);
  EXPECT_NEAR(found.T_base_laser.x, truth.T_base_laser.x, 0.005);
  EXPECT_NEAR(found.T_base_laser.y, truth.T_base_laser.y, 0.005);
  EXPECT_NEAR(rad_to_deg(wrap_angle(found.T_base_laser.phi - truth.T_base_laser.phi)), 0.0, 0.3);
  EXPECT_NEAR(found.delay, truth.delay, 0.005);
}

TEST(Calibration, PlantedSetupsComeBackWithHonestUncertainties) {
  double squares = 0.0;
  int count = 0;
  for (const std::uint64_t seed : kSeeds) {
    RecordingPlan plan;
    plan.seed = seed;
    plan.truth = planted(seed);
    const Calibration c = calibrated(plan);
    SCOPED_TRACE("seed " + std::to_string(seed));
    EXPECT_EQ(c.refusal, "");
    expect_found(c.setup, plan.truth);
    const std::vector<double> found = numbers(c.setup), truth = numbers(plan.truth), sigma = numbers(c.sigma);
    std::cout << "seed " << seed << ":";
    for (std::size_t i = 0; i < found.size(); ++i) {
      std::cout << "  " << found[i] - truth[i] << " +- " << sigma[i];
      squares += std::pow((found[i] - truth[i]) / sigma[i], 2);
      ++count;
    }
    std::cout << "\n";
  }
  const double normalised = std::sqrt(squares / count);
  std::cout << "error in units of the told uncertainty, root mean square: " << normalised << "\n";
  EXPECT_LT(normalised, 2.0);
  EXPECT_GT(normalised, 0.4);
}

TEST(Calibration, ExactSensorsLeaveNextToNoError) {
  RecordingPlan plan;
  plan.truth = planted(7);
  plan.range_sigma = 0.0;
  plan.slip = 0.0;
  const Calibration c = calibrated(plan);
  const std::vector<double> found = numbers(c.setup), truth = numbers(plan.truth);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i], truth[i], 0.001) << i;
    std::cout << "number " << i << ": off by " << found[i] - truth[i] << "\n";
  }
}

TEST(Calibration, AScannerMountedBackwardsIsFound) {
  RecordingPlan plan;
  plan.truth = {1.0, 1.0, {-0.1, 0.05, deg_to_rad(172.0)}, 0.03};
  const Calibration c = calibrated(plan);
  EXPECT_EQ(c.refusal, "");
  expect_found(c.setup, plan.truth);
}

TEST(Calibration, WhatIsFoundIsFoundAgainFromItself) {
  RecordingPlan plan;
  plan.truth = planted(3);
  const Calibration once = calibrated(plan);
  RobotSetup start = once.setup;
  const Calibration twice = calibrated(plan, start);
  const std::vector<double> a = numbers(once.setup), b = numbers(twice.setup), sigma = numbers(once.sigma);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 0.2 * sigma[i]) << i;
}

/// The zero alone, from a recording without scans.
std::optional<LevelZero> zero_of(const RecordingPlan& plan) {
  WheelTrack wheels;
  std::vector<robot::Acceleration> accelerations;
  for (const robot::Inputs& tick : slam_test::calibration_recording({}, plan)) {
    wheels.add(tick.odometry.front());
    accelerations.insert(accelerations.end(), tick.accelerations.begin(), tick.accelerations.end());
  }
  wheels.scale(plan.truth.distance_scale, plan.truth.turn_scale);
  return level_zero(accelerations, {}, wheels, robot::AccelerometerMount::Body);
}

TEST(LevelZero, TheZeroIsToldApartFromTheFloorsSlope) {
  for (const std::uint64_t seed : kSeeds) {
    RecordingPlan plan;
    plan.seed = seed;
    plan.truth = planted(seed);
    plan.zero_pitch = deg_to_rad(2.0);
    plan.zero_roll = deg_to_rad(-1.5);
    plan.slope = deg_to_rad(1.2);
    const std::optional<LevelZero> zero = zero_of(plan);
    ASSERT_TRUE(zero) << "seed " << seed;
    EXPECT_TRUE(zero->slope_known);
    EXPECT_NEAR(rad_to_deg(zero->pitch), 2.0, 0.1) << "seed " << seed;
    EXPECT_NEAR(rad_to_deg(zero->roll), -1.5, 0.1) << "seed " << seed;
    EXPECT_NEAR(rad_to_deg(zero->slope), 1.2, 0.1) << "seed " << seed;
    EXPECT_LT(rad_to_deg(zero->pitch_sigma), 0.1);
    EXPECT_GT(rad_to_deg(zero->pitch_sigma), 0.001);
  }
}

TEST(LevelZero, WithoutATurnTheFloorIsTakenToBeLevel) {
  RecordingPlan plan;
  plan.turn_to = 0.0;
  plan.slope = deg_to_rad(1.0);
  const std::optional<LevelZero> zero = zero_of(plan);
  ASSERT_TRUE(zero);
  EXPECT_FALSE(zero->slope_known);
  EXPECT_NEAR(rad_to_deg(zero->pitch), 1.0, 0.1);
}

TEST(LevelZero, ARobotThatNeverStandsTellsNothing) {
  WheelTrack wheels;
  std::vector<robot::Acceleration> accelerations;
  for (int i = 0; i < 100; ++i) {
    const Stamp stamp = Stamp::from_seconds(0.1 * i);
    wheels.add({stamp, {0.02 * i, 0.0, 0.0}, 0.2, 0.0, false});
    accelerations.push_back({stamp, 0.0, 0.0});
  }
  EXPECT_FALSE(level_zero(accelerations, {}, wheels, robot::AccelerometerMount::Body));
}

TEST(Calibration, TooLittleMotionIsRefusedAndNamed) {
  RecordingPlan still;
  still.squares = 0;
  EXPECT_NE(calibrated(still).refusal.find("only"), std::string::npos);

  RecordingPlan straight;
  straight.turn_to = 0.0;
  straight.squares = 1;
  EXPECT_NE(calibrated(straight).refusal.find("turned only 0 deg"), std::string::npos) << calibrated(straight).refusal;

  RecordingPlan spinning;
  spinning.side = 0.0;
  EXPECT_NE(calibrated(spinning).refusal.find("drove only 0.0 m"), std::string::npos) << calibrated(spinning).refusal;

  RecordingPlan brief;
  brief.seconds = 8.0;
  EXPECT_NE(calibrated(brief).refusal.find("scans"), std::string::npos) << calibrated(brief).refusal;
}

TEST(Calibration, ARoomThatTurnsAlongIsRefused) {
  // Scans of a robot that stands, wheels of one that drives: nothing fits.
  RecordingPlan plan;
  std::vector<robot::Inputs> ticks = slam_test::calibration_recording(slam_test::furnished_room(), plan);
  Calibrator calibrator;
  const robot::LaserScan first = ticks.front().scans.front();
  for (robot::Inputs& tick : ticks) {
    tick.scans.front().ranges = first.ranges;
    calibrator.add(tick);
  }
  const Calibration c = calibrator.calibrate(taken_for(), robot::AccelerometerMount::Body);
  EXPECT_NE(c.refusal, "");
  std::cout << c.refusal << "\n";
}

TEST(Calibration, TheSameRecordingGivesTheSameBits) {
  RecordingPlan plan;
  plan.truth = planted(2);
  EXPECT_EQ(numbers(calibrated(plan).setup), numbers(calibrated(plan).setup));
}

}  // namespace
}  // namespace rubble::slam
