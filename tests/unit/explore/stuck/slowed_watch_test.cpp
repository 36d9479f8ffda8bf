#include "explore/stuck/slowed_watch.h"

#include <gtest/gtest.h>

namespace rubble::explore {
namespace {

using mrpt::math::TPose2D;
using robot::Drive;

constexpr double kSlowedTick = 0.02;

/// A robot whose wheels drive it on; after a weak blow, or none, it does a share of that, and turns beside. When it is
/// taken to be held [s after the blow]; below 0: it is not. `pitches`: then [rad/s].
double held_after(bool blow, const Drive& wheels, double share, double turns_beside, double jump = 0.0,
                  double pitches = 0.0) {
  SlowedWatch watch;
  TPose2D pose;
  Stamp now = Stamp::from_seconds(1.0);
  for (int i = 0; i < 50; ++i, now = now + kSlowedTick) {
    pose = pose + TPose2D{wheels.v * kSlowedTick, 0.0, wheels.w * kSlowedTick};
    if (watch.held(false, pose, wheels, 0.0, kSlowedTick, now)) return 0.0;
  }
  for (int i = 0; i < 100; ++i, now = now + kSlowedTick) {
    if (watch.held(blow && i == 0, pose, wheels, pitches * i * kSlowedTick, kSlowedTick, now)) return i * kSlowedTick;
    pose = pose + TPose2D{share * wheels.v * kSlowedTick + (i == 5 ? jump : 0.0), 0.0,
                          (wheels.w + turns_beside) * kSlowedTick};
  }
  return -1.0;
}

TEST(SlowedWatch, ARobotThatFallsBehindItsWheelsAfterAWeakBlowHasMetSomething) {
  for (const double v : {0.2, 0.4, -0.2}) {
    const double after = held_after(true, {v, 0.0}, 0.2, 0.0);
    EXPECT_GT(after, 0.0) << v;
    EXPECT_LT(after, 0.35) << v;
    EXPECT_LT(held_after(false, {v, 0.0}, 0.2, 0.0), 0.0) << "without a blow that is another's matter";
  }
}

TEST(SlowedWatch, OneThatIsTurnedAsideHasAsWell) {
  EXPECT_GT(held_after(true, {0.3, 0.0}, 1.0, 0.4), 0.0);
  EXPECT_GT(held_after(true, {0.3, 0.5}, 1.0, -0.8), 0.0);
}

/// The edge of a ramp: it slips a little, and goes on.
TEST(SlowedWatch, OneThatGoesOnHasPassedIt) {
  for (const double w : {0.0, 0.6}) EXPECT_LT(held_after(true, {0.4, w}, 0.85, 0.05), 0.0) << w;
}

/// While its servos follow, the map's pose lags behind.
TEST(SlowedWatch, OneThatTipsOverACrestHasMetNothing) {
  EXPECT_LT(held_after(true, {0.4, 0.0}, 0.6, 0.0, 0.0, -0.5), 0.0);
  EXPECT_GT(held_after(true, {0.4, 0.0}, 0.6, 0.0, 0.0, 0.1), 0.0) << "a wheel climbs a little";
}

TEST(SlowedWatch, APoseThatIsCorrectedTellsNothing) { EXPECT_LT(held_after(true, {0.3, 0.0}, 1.0, 0.0, -0.15), 0.0); }

}  // namespace
}  // namespace rubble::explore
