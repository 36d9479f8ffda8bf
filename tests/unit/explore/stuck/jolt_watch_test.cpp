#include "explore/stuck/jolt_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/angle.h"
#include "base/rng.h"
#include "robot/model.h"

namespace rubble::explore {
namespace {

constexpr double kTick = 0.02;  // [s]
constexpr double kGravity = 9.81;

struct Told {
  int blows = 0;
  int from_ahead = 0;
  int shaken = 0;
};

/// Two seconds at `speed` [m/s] of the wheels; `felt`: along the body at a time [m/s^2]; `braked`: when it was told to.
Told drive(double speed, const std::function<double(double)>& felt, Stamp braked = Stamp::never()) {
  JoltWatch watch;
  Told told;
  for (int i = 1; i <= 100; ++i) {
    const Stamp now = Stamp::from_seconds(i * kTick);
    robot::Inputs inputs;
    inputs.now = now;
    inputs.accelerations.push_back({now, felt(i * kTick), 0.0});
    if (i % 5 == 0) inputs.odometry.push_back({now, {}, speed, 0.0, false});
    watch.update(inputs);
    if (now == braked) watch.braked(now);
    told.blows += watch.struck() ? 1 : 0;
    told.shaken += watch.shaken() ? 1 : 0;
    told.from_ahead += watch.struck() && watch.from_ahead() ? 1 : 0;
  }
  return told;
}

/// The speed is lost evenly within `lasts` seconds from 1 s on.
std::function<double(double)> blow(double speed, double lasts, double rest = 0.0) {
  return [=](double t) { return rest - (t > 1.0 && t <= 1.0 + lasts + 1e-9 ? speed / lasts : 0.0); };
}

TEST(JoltWatch, ABlowThatTakesTheSpeedIsToldOnce) {
  for (const double speed : {0.15, 0.25, 0.4, 0.7})
    for (const double lasts : {0.02, 0.04}) {
      const Told ahead = drive(speed, blow(speed, lasts));
      EXPECT_EQ(ahead.blows, 1) << speed << " " << lasts;
      EXPECT_EQ(ahead.from_ahead, 1);
      const Told behind = drive(-speed, blow(-speed, lasts));
      EXPECT_EQ(behind.blows, 1) << speed << " " << lasts;
      EXPECT_EQ(behind.from_ahead, 0);
    }
}

TEST(JoltWatch, BrakingIsNoBlow) {
  const double accel = robot::RobotModel().max_accel;
  EXPECT_EQ(drive(0.4, blow(0.4, 0.4 / accel)).blows, 0);
}

/// As hard as the base can: the wheels' report comes after the body has stopped.
TEST(JoltWatch, ItsOwnBrakeIsNoBlow) {
  const auto felt = blow(0.4, 0.04);
  const Stamp braked = Stamp::from_seconds(1.0);
  EXPECT_EQ(drive(0.4, felt, braked).blows, 0);
  EXPECT_EQ(drive(
                0.4, [&](double t) { return felt(t - 0.6); }, braked)
                .blows,
            1)
      << "but one that comes later is";
}

TEST(JoltWatch, AKnockThatTakesLittleOfTheSpeedIsNone) { EXPECT_EQ(drive(0.4, blow(0.15, 0.02)).blows, 0); }

TEST(JoltWatch, AKnockThatTakesHalfOfTheSpeedIsAWeakBlow) {
  for (const double speed : {0.2, 0.4}) {
    const Told told = drive(speed, blow(0.55 * speed, 0.02));
    EXPECT_GT(told.shaken, 0) << speed;
    EXPECT_EQ(told.blows, 0) << speed;
  }
  EXPECT_EQ(drive(0.4, blow(0.1, 0.02)).shaken, 0);
}

TEST(JoltWatch, APushFromBehindIsNone) { EXPECT_EQ(drive(0.3, blow(-0.3, 0.02)).blows, 0); }

/// The platform lags behind the body by so much that it feels a share of gravity.
TEST(JoltWatch, TheEdgeOfARampIsNone) {
  for (const double degrees : {-20.0, -10.0, 10.0, 20.0}) {
    const double most = kGravity * std::sin(deg_to_rad(degrees));
    const auto lag = [&](double t) {
      return t < 1.0 ? 0.0 : most * std::min(1.0, (t - 1.0) / 0.3) * std::exp(-3.0 * (t - 1.0));
    };
    EXPECT_EQ(drive(0.3, lag).blows, 0) << degrees;
  }
}

TEST(JoltWatch, OnASlopeTheBodysOwnShareOfGravityIsLeftOut) {
  const double share = -kGravity * std::sin(deg_to_rad(15.0));
  EXPECT_EQ(drive(0.3, [&](double) { return share; }).blows, 0);
  EXPECT_EQ(drive(0.3, blow(0.3, 0.02, share)).blows, 1);
}

TEST(JoltWatch, NoiseIsNone) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed, "jolts");
    EXPECT_EQ(drive(0.4, [&](double) { return rng.gaussian(0.5); }).blows, 0) << "seed " << seed;
  }
}

TEST(JoltWatch, AStandingRobotThatIsPushedIsNotStopped) { EXPECT_EQ(drive(0.0, blow(0.4, 0.02)).blows, 0); }

}  // namespace
}  // namespace rubble::explore
