// What stops a Pioneer, and what does not set it in motion again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/pioneer_wire.h"

namespace rubble::robot {
namespace {

TEST(PioneerWire, TheWatchdogStopsARobotWithoutCommandsAndFreshOnesDoNotTripIt) {
  Wire wire;
  wire.run(1.0);
  wire.go(0.3, 0.0);
  wire.run(10.0);
  EXPECT_FALSE(wire.base.is_held());
  wire.cut = true;
  wire.run(2.2);
  EXPECT_TRUE(wire.base.is_held());
  wire.run(1.5);
  EXPECT_EQ(wire.base.motion().v, 0.0);
}

TEST(PioneerWire, TheSpeedLimitHoldsWhateverIsAskedFor) {
  BaseSettings settings;
  settings.max_v = 0.25;
  settings.max_w = deg_to_rad(30.0);
  Wire wire({}, settings);
  wire.run(1.0);
  wire.go(5.0, -9.0);
  for (int i = 0; i < 3000; ++i) {
    wire.step();
    ASSERT_LE(std::abs(wire.base.motion().v), 0.25 + 1e-9);
    ASSERT_LE(std::abs(wire.base.motion().w), deg_to_rad(30.0) + 1e-9);
  }
  EXPECT_NEAR(wire.base.motion().v, 0.25, 1e-9);
}

TEST(PioneerWire, AnEmergencyStopStopsAtOnceAndStaysUntilEnabled) {
  Wire wire;
  wire.run(1.0);
  wire.go(0.5, 0.0);
  wire.run(4.0);
  wire.driver.emergency_stop();
  wire.run(0.05);
  EXPECT_EQ(wire.base.motion().v, 0.0);
  wire.driver.drive({0.5, 0.0});
  wire.run(1.0);
  EXPECT_EQ(wire.base.motion().v, 0.0);
  EXPECT_FALSE(wire.base.motors_on());
}

/// A firmware that hears no order to stop may still hear CLOSE, and else nobody.
TEST(PioneerWire, ABaseWhoseMotorsStayOnIsClosedAndLeftToItsWatchdog) {
  for (const bool hears_close : {true, false}) {
    SCOPED_TRACE(hears_close);
    Wire wire;
    wire.run(1.0);
    wire.go(0.4, 0.0);
    wire.run(4.0);
    ASSERT_NEAR(wire.base.motion().v, 0.4, 1e-9);
    wire.deaf_to = [hears_close](const std::string& packet) {
      const auto number = static_cast<std::uint8_t>(packet.size() > 3 ? packet[3] : 0);
      return number == arcos::kEnable || number == arcos::kVelocity || number == arcos::kTurnRate ||
             number == arcos::kStop || number == arcos::kEmergencyStop || (number == arcos::kClose && !hears_close);
    };
    wire.driver.emergency_stop();
    wire.run(1.5);
    EXPECT_TRUE(wire.driver.ready()) << "it may be late";
    wire.run(5.0);
    for (int i = 0; i < 10000; ++i) {
      wire.step();
      ASSERT_EQ(wire.base.motion().v, 0.0) << "it drives after " << 6.5 + 1e-3 * i << " s";
    }
    if (hears_close) {
      EXPECT_FALSE(wire.base.motors_on());
      EXPECT_TRUE(wire.run_until([&] { return wire.driver.ready(); }, 5.0)) << wire.driver.state();
    } else {
      EXPECT_THAT(wire.driver.state(), testing::HasSubstr("left to its watchdog"));
      wire.deaf_to = {};
      wire.base.client_came(wire.now);  // somebody has switched it off and on
      EXPECT_TRUE(wire.run_until([&] { return wire.driver.ready(); }, 10.0)) << wire.driver.state();
    }
  }
}

/// Somebody else's orders arrive, ours do not, until the line is well again.
TEST(PioneerWire, ABaseLeftToItsWatchdogIsToldToStopNowAndThenForItMayHearAgain) {
  Wire wire;
  wire.run(1.0);
  wire.go(0.4, 0.0);
  wire.run(2.0);
  wire.deaf_to = [](const std::string&) { return true; };
  wire.driver.emergency_stop();
  const auto driven_on = [&](double seconds) {
    for (const Stamp end = wire.now + seconds; wire.now < end; wire.run(0.2))
      wire.base.receive(arcos::command(arcos::kVelocity, 250), wire.now);
  };
  driven_on(5.0);
  EXPECT_THAT(wire.driver.state(), testing::HasSubstr("left to its watchdog"));
  wire.said.clear();
  driven_on(20.0);
  EXPECT_NEAR(wire.base.motion().v, 0.25, 1e-9);
  const auto told = std::count(wire.said.begin(), wire.said.end(), arcos::command(arcos::kEmergencyStop));
  EXPECT_GE(told, 3);
  EXPECT_LE(told, 5) << "its watchdog works only while nobody speaks to it";
  wire.deaf_to = {};
  driven_on(6.0);
  EXPECT_FALSE(wire.base.motors_on());
  EXPECT_EQ(wire.base.motion().v, 0.0);
}

TEST(PioneerWire, BrakingTakesNoRampAndTheNextSetPointDrivesAgain) {
  for (const bool brake : {false, true}) {
    Wire wire;
    wire.run(1.0);
    wire.go(0.4, 0.5);
    wire.run(4.0);
    ASSERT_NEAR(wire.base.motion().v, 0.4, 1e-9);
    brake ? wire.driver.brake() : wire.driver.drive({});
    wire.run(0.05);
    if (brake) {
      EXPECT_EQ(wire.base.motion().v, 0.0);
      EXPECT_EQ(wire.base.motion().w, 0.0);
    } else {
      EXPECT_GT(wire.base.motion().v, 0.3) << "the ramp";
    }
    wire.run(2.0);
    EXPECT_EQ(wire.base.motion().v, 0.0);
    EXPECT_TRUE(wire.base.motors_on());
    wire.driver.drive({-0.2, 0.0});
    wire.run(2.0);
    EXPECT_NEAR(wire.base.motion().v, -0.2, 1e-9);
  }
}

TEST(PioneerWire, NothingQueuedSwitchesTheMotorsOnBehindAStop) {
  for (const bool hard : {false, true}) {
    Wire wire;
    wire.run(1.0);
    // ENABLE 1 waits behind another command when the stop comes.
    wire.driver.enable(true);
    wire.driver.drive({0.5, 0.5});
    wire.driver.advance(wire.now + 0.0005);
    hard ? wire.driver.emergency_stop() : wire.driver.stop();
    std::vector<std::string> sent;
    for (int i = 0; i < 400; ++i) {
      wire.now = wire.now + kStep;
      wire.driver.advance(wire.now);
      const std::string out = wire.driver.take_output(wire.now);
      if (!out.empty()) sent.push_back(out);
    }
    ASSERT_GE(sent.size(), 2u);
    EXPECT_EQ(sent[0], arcos::command(hard ? arcos::kEmergencyStop : arcos::kStop));
    EXPECT_EQ(sent[1], arcos::command(arcos::kEnable, 0));
    EXPECT_THAT(sent, testing::Not(testing::Contains(arcos::command(arcos::kEnable, 1))));
  }
}

/// What the robot's own buttons stop stays stopped until the operator says so, whatever is asked for meanwhile.
class StoppedAtTheRobot : public testing::TestWithParam<std::pair<DeviceFault, Pioneer::Hold>> {};

TEST_P(StoppedAtTheRobot, StaysStoppedUntilItIsRearmed) {
  const auto [fault, hold] = GetParam();
  Wire wire;
  wire.run(1.0);
  wire.go(0.4, 0.0);
  wire.run(2.0);
  ASSERT_EQ(wire.driver.hold(), Pioneer::Hold::None);
  ASSERT_TRUE(wire.base.fail(fault, wire.now));
  wire.run(0.3);
  EXPECT_EQ(wire.driver.hold(), hold);
  const double there = wire.truth.x;
  for (int i = 0; i < 50; ++i) {
    wire.driver.enable(true);
    wire.driver.drive({0.4, 0.0});
    wire.run(0.1);
    ASSERT_FALSE(wire.base.motors_on()) << "switched on again after " << 0.1 * i << " s";
  }
  EXPECT_EQ(wire.truth.x, there);
  wire.driver.rearm();
  wire.go(0.4, 0.0);
  wire.run(2.0);
  EXPECT_TRUE(wire.base.motors_on());
  EXPECT_GT(wire.truth.x, there + 0.2);
}

INSTANTIATE_TEST_SUITE_P(Buttons, StoppedAtTheRobot,
                         testing::Values(std::make_pair(DeviceFault::Button, Pioneer::Hold::EmergencyButton),
                                         std::make_pair(DeviceFault::Motors, Pioneer::Hold::MotorsOff)));

TEST(PioneerWire, APressedButtonCannotBeRearmed) {
  Wire wire;
  wire.run(1.0);
  wire.go(0.4, 0.0);
  wire.base.fail(DeviceFault::Button, wire.now);
  wire.run(0.5);
  wire.driver.rearm();
  EXPECT_EQ(wire.driver.hold(), Pioneer::Hold::EmergencyButton);
}

TEST(PioneerWire, MotorsThatWeSwitchOffOrThatARestartLeavesOffAreNoHold) {
  Wire wire;
  wire.run(1.0);
  for (int i = 0; i < 3; ++i) {
    wire.go(0.2, 0.0);
    wire.run(0.5);
    wire.driver.enable(false);
    wire.run(0.05 * i);
  }
  wire.go(0.2, 0.0);
  wire.base.fail(DeviceFault::Reset, wire.now);
  wire.run(8.0);
  EXPECT_EQ(wire.driver.hold(), Pioneer::Hold::None);
  EXPECT_TRUE(wire.driver.motors_on());
}

TEST(PioneerWire, TheFarewellLeavesARobotAtRest) {
  Wire wire;
  wire.run(1.0);
  wire.go(0.5, 0.0);
  wire.run(2.0);
  for (const std::string& packet : wire.driver.farewell()) wire.base.receive(packet, wire.now);
  EXPECT_FALSE(wire.base.open());
  EXPECT_FALSE(wire.base.motors_on());
}

/// The firmware wants some milliseconds between two commands.
TEST(PioneerWire, TheFarewellIsThreePacketsApart) {
  Wire wire;
  wire.run(1.0);
  EXPECT_THAT(wire.driver.farewell(),
              testing::ElementsAre(arcos::command(arcos::kStop), arcos::command(arcos::kEnable, 0),
                                   arcos::command(arcos::kClose)));
  EXPECT_GE(Device::kPause, 0.003);
}

}  // namespace
}  // namespace rubble::robot
