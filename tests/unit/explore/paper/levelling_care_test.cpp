#include "explore/paper/levelling_care.h"

#include <gtest/gtest.h>

namespace rubble::explore {
namespace {

/// One tick at `seconds`; `talks`: the unit reports a level laser.
robot::Inputs unit_tick(double seconds, bool talks) {
  robot::Inputs inputs;
  inputs.now = Stamp::from_seconds(seconds);
  if (talks) {
    inputs.aims.push_back({inputs.now, 0.0, 0.0});
    inputs.accelerations.push_back({inputs.now, 0.0, 0.0});
  }
  return inputs;
}

TEST(LevellingCare, ASilentUnitIsWaitedForAndThenGivenUp) {
  LevellingCare care{robot::RobotModel()};
  double waits = 0.0;
  int lines = 0;
  for (double t = 0.0; t < 20.0; t += 0.02) {
    care.update(unit_tick(t, t < 10.0));
    waits += care.waits() ? 0.02 : 0.0;
    lines += care.news().empty() ? 0 : 1;
    EXPECT_TRUE(care.works() || t > 10.9) << t;
    EXPECT_TRUE(!care.given_up() || t > 15.9) << t;
  }
  EXPECT_NEAR(waits, 5.0, 0.1);
  EXPECT_EQ(lines, 1);
  EXPECT_FALSE(care.works());
  EXPECT_TRUE(care.given_up());
  care.update(unit_tick(20.0, true));
  EXPECT_TRUE(care.given_up()) << "it drives home by now";
}

TEST(LevellingCare, AUnitThatTalksAgainIsForgiven) {
  LevellingCare care{robot::RobotModel()};
  for (double t = 0.0; t < 30.0; t += 0.02) care.update(unit_tick(t, t < 10.0 || t > 14.0));
  EXPECT_TRUE(care.works());
  EXPECT_FALSE(care.waits());
  EXPECT_FALSE(care.given_up());
}

TEST(LevellingCare, WithoutAUnitThereIsNothingToCareFor) {
  LevellingCare care{robot::RobotModel()};
  for (double t = 0.0; t < 30.0; t += 0.02) {
    care.update(unit_tick(t, false));
    EXPECT_TRUE(care.news().empty());
  }
  EXPECT_TRUE(care.works());
  EXPECT_FALSE(care.waits());
}

}  // namespace
}  // namespace rubble::explore
