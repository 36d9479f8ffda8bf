#include "explore/stuck/brake_test.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "base/angle.h"
#include "base/rng.h"

namespace rubble::explore {
namespace {

constexpr double kSample = 0.02;  // [s]
constexpr double kBrakes = 1.0;
constexpr double kEarth = 9.81;
using Verdict = BrakeTest::Verdict;

/// A test that begins after a second at `wheels` [m/s]; `felt`: along the body at a time [m/s^2].
Verdict verdict(double wheels, const std::function<double(double)>& felt) {
  BrakeTest test;
  for (int i = 1; i * kSample < kBrakes + 1.0; ++i) {
    const Stamp now = Stamp::from_seconds(i * kSample);
    robot::Inputs inputs;
    inputs.now = now;
    inputs.accelerations.push_back({now, felt(i * kSample), 0.0});
    test.update(inputs);
    if (i * kSample < kBrakes - 1e-9) continue;
    if (i * kSample < kBrakes + kSample - 1e-9) {
      EXPECT_TRUE(test.can_tell(wheels, now));
      test.begin(wheels, now);
    }
    if (test.verdict(now) != Verdict::Open) return test.verdict(now);
  }
  return Verdict::Open;
}

/// A body at `speed` loses it evenly within `lasts` seconds once it brakes, and feels `rest` all the time.
std::function<double(double)> stops(double speed, double lasts = 0.1, double rest = 0.0) {
  return [=](double t) { return rest - (t > kBrakes + 1e-9 && t <= kBrakes + lasts + 1e-9 ? speed / lasts : 0.0); };
}

TEST(BrakeTest, ABodyThatMovedFeelsItsBrakeAndOneThatStoodDoesNot) {
  for (const double speed : {0.2, 0.4, 0.7, -0.2, -0.4})
    for (const double lasts : {0.02, 0.06, 0.1}) {
      EXPECT_EQ(verdict(speed, stops(speed, lasts)), Verdict::Moved) << speed << " " << lasts;
      EXPECT_EQ(verdict(speed, stops(0.0, lasts)), Verdict::Stood) << speed;
      EXPECT_EQ(verdict(speed, stops(0.25 * speed, lasts)), Verdict::Stood) << speed << ": it crept";
      EXPECT_EQ(verdict(speed, stops(-speed, lasts)), Verdict::Stood) << speed << ": it slid back";
    }
}

/// Wheels that climbed what holds them let the body drop back: it falls and is caught, and stood before and after.
TEST(BrakeTest, ABodyThatRocksStood) {
  const auto rocks = [](double t) {
    const double after = t - kBrakes;
    return after > 1e-9 && after <= 0.12 + 1e-9 ? (after <= 0.06 + 1e-9 ? -5.0 : 5.0) : 0.0;
  };
  EXPECT_EQ(verdict(0.4, rocks), Verdict::Stood);
  EXPECT_EQ(verdict(-0.4, rocks), Verdict::Stood);
}

/// A levelling unit that knows of the wheels' stop, and not that the body stood, tilts the platform for it.
/// As in simulated drives: 7.5 deg at 0.13 s after a stop from 0.36 m/s, in proportion to the speed, softly at first.
TEST(BrakeTest, WhatTheLevellingMakesOfTheStopOfTheWheelsIsNoMotion) {
  for (const double speed : {0.3, 0.4, 0.6}) {
    const auto tilts = [&](double t) {
      const double after = std::max(0.0, t - kBrakes);
      const double lean = deg_to_rad(7.5) * (speed / 0.36) * std::pow(after / 0.13, 3) * std::exp(3.0 - after / 0.0433);
      return -kEarth * std::sin(lean);
    };
    EXPECT_EQ(verdict(speed, tilts), Verdict::Stood) << speed;
  }
}

TEST(BrakeTest, OnASlopeTheShareOfGravityIsLeftOut) {
  for (const double degrees : {-15.0, -10.0, 10.0, 15.0}) {
    const double share = -kEarth * std::sin(deg_to_rad(degrees));
    EXPECT_EQ(verdict(0.3, stops(0.3, 0.1, share)), Verdict::Moved) << degrees;
    EXPECT_EQ(verdict(0.3, stops(0.0, 0.1, share)), Verdict::Stood) << degrees;
  }
}

TEST(BrakeTest, NoiseChangesNoVerdict) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed, "brake");
    const auto noisy = [&](const std::function<double(double)>& felt) {
      return [&rng, felt](double t) { return felt(t) + rng.gaussian(0.3); };
    };
    EXPECT_EQ(verdict(0.3, noisy(stops(0.3))), Verdict::Moved) << "seed " << seed;
    EXPECT_EQ(verdict(0.3, noisy(stops(0.0))), Verdict::Stood) << "seed " << seed;
  }
}

TEST(BrakeTest, CannotTellOfSlowWheelsNorWithoutAnAccelerometer) {
  const Stamp now = Stamp::from_seconds(1.0);
  BrakeTest test;
  EXPECT_FALSE(test.can_tell(0.5, now)) << "none was heard";
  robot::Inputs inputs;
  inputs.now = now;
  inputs.accelerations.push_back({now, 0.0, 0.0});
  test.update(inputs);
  EXPECT_TRUE(test.can_tell(0.5, now));
  EXPECT_TRUE(test.can_tell(-0.5, now));
  EXPECT_FALSE(test.can_tell(0.1, now));
  EXPECT_FALSE(test.can_tell(0.5, now + 1.0)) << "it fell silent";
}

}  // namespace
}  // namespace rubble::explore
