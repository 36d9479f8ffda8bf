#include "sim/battery.h"

#include <gtest/gtest.h>

#include "tests/support/sim_arena.h"

namespace rubble::sim::test {
namespace {

/// How long a full battery of `wh` lasts [s].
double lasts(double wh, const robot::Drive& drive) {
  Battery battery(wh);
  double time = 0.0;
  for (; !battery.empty(); time += 0.5) battery.draw(drive, 0.5);
  return time;
}

TEST(Battery, LastsInProportionToWhatItHoldsAndShorterTheMoreIsAsked) {
  EXPECT_NEAR(lasts(20.0, {0.4, 0.0}), 2.0 * lasts(10.0, {0.4, 0.0}), 1.0);
  EXPECT_GT(lasts(10.0, {}), lasts(10.0, {0.2, 0.0}));
  EXPECT_GT(lasts(10.0, {0.2, 0.0}), lasts(10.0, {0.4, 0.0}));
  EXPECT_GT(lasts(10.0, {0.4, 0.0}), lasts(10.0, {0.4, -0.5}));
  EXPECT_NEAR(lasts(10.0, {-0.4, 0.5}), lasts(10.0, {0.4, -0.5}), 1e-9);
}

TEST(Battery, ItsVoltageFallsAndSagsUnderLoad) {
  Battery battery(10.0);
  double last = 13.0;
  for (int i = 0; i < 400; ++i) {
    battery.draw({0.4, 0.0}, 1.0);
    EXPECT_LT(battery.volts(), last);
    last = battery.volts();
  }
  battery.draw({}, 0.01);
  EXPECT_GT(battery.volts(), last);
}

TEST(Battery, TheSimulatedRobotTellsItsVoltageEachSecondAndStandsWithoutCurrent) {
  SimConfig config = exact();
  config.battery_wh = 0.1;  // 360 J
  SimRobot robot(flat_floor(-5, -5, 5, 5), {}, config, 1);
  std::size_t told = 0;
  double at_two = 0.0, at_eight = 0.0;
  while (robot.truth().back().stamp < Stamp::from_seconds(10.0)) {
    const auto inputs = robot.read();
    ASSERT_TRUE(inputs);
    if (inputs->battery) ++told;
    robot.command({{0.3, 0.0}, {}});
    const double now = inputs->now.seconds(), x = robot.truth().back().pose.x;
    if (now <= 2.0) at_two = x;
    if (now <= 8.0) at_eight = x;
  }
  EXPECT_EQ(told, 11u);
  EXPECT_GT(at_two, 0.3);
  EXPECT_NEAR(robot.truth().back().pose.x, at_eight, 1e-3);
}

TEST(Battery, WithoutOneNothingIsTold) {
  SimRobot robot(flat_floor(-5, -5, 5, 5), {}, exact(), 1);
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(robot.read()->battery);
}

}  // namespace
}  // namespace rubble::sim::test
