#include "explore/stuck/tilt_watch.h"

#include <gtest/gtest.h>

#include "base/angle.h"

namespace rubble::explore {
namespace {

constexpr double kTiltTick = 0.02;  // [s]

TEST(TiltWatch, TakesTheServosAnglesForTheBodysTiltAndAsksForPatience) {
  TiltWatchConfig config;
  TiltWatch tilt(config);
  robot::Inputs inputs;
  inputs.aims.push_back({Stamp{}, deg_to_rad(-25.0), 0.0});  // the laser looks down to stay level: nose up
  tilt.update(inputs, kTiltTick);
  EXPECT_FALSE(tilt.too_steep());
  for (int i = 0; i < 100; ++i) tilt.update(inputs, kTiltTick);
  EXPECT_NEAR(tilt.lean().pitch, deg_to_rad(25.0), 0.01);
  EXPECT_TRUE(tilt.too_steep());
  inputs.aims.back().pitch = deg_to_rad(-10.0);  // a ramp of the arena
  for (int i = 0; i < 100; ++i) tilt.update(inputs, kTiltTick);
  EXPECT_FALSE(tilt.too_steep());
}

/// The levelling unit dies while the laser is tilted: its last angles are not believed for ever.
TEST(TiltWatch, ALevellingUnitThatFailedSaysNothingAboutTheGround) {
  TiltWatch watch;
  robot::Inputs inputs;
  inputs.aims.push_back({Stamp::from_seconds(1.0), deg_to_rad(30.0), 0.0});
  for (int i = 0; i < 100; ++i) watch.update(inputs, 0.02);
  EXPECT_TRUE(watch.too_steep());
  inputs.aims.clear();
  double silent = 0.0;
  for (; watch.too_steep(); silent += 0.02) {
    watch.update(inputs, 0.02);
    ASSERT_LT(silent, 3.0);
  }
  EXPECT_GT(silent, 0.2) << "a few lost messages are no failure";
  for (int i = 0; i < 50; ++i) watch.update(inputs, 0.02);
  EXPECT_LT(watch.slope(), deg_to_rad(1.0));
}

/// Servos that jammed are told to turn to the end of their travel.
TEST(TiltWatch, AnglesThatAreNotBelievedAreNoTilt) {
  TiltWatch watch;
  watch.distrust();
  robot::Inputs inputs;
  inputs.aims.push_back({Stamp::from_seconds(1.0), deg_to_rad(30.0), 0.0});
  for (int i = 0; i < 200; ++i) watch.update(inputs, 0.02);
  EXPECT_FALSE(watch.too_steep());
  EXPECT_LT(watch.slope(), deg_to_rad(1.0));
}

}  // namespace
}  // namespace rubble::explore
