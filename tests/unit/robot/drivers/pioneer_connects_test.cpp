// The Pioneer's driver finds its base: handshake, names, units, and all over again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/pioneer_wire.h"

namespace rubble::robot {
namespace {

TEST(PioneerWire, TheHandshakeEndsInReports) {
  Wire wire;
  ASSERT_TRUE(wire.run_until([&] { return wire.driver.ready(); }, 2.0)) << wire.driver.state();
  EXPECT_EQ(wire.driver.identity().subclass, "p3at-sh");
  wire.run(0.2);
  EXPECT_EQ(wire.driver.configuration().cycle_ms, 100);
  EXPECT_NEAR(wire.driver.battery(), 12.8, 1e-9);
  EXPECT_FALSE(wire.base.motors_on());
}

TEST(PioneerWire, AfterAResetTheConnectionIsMadeAnewAndThePoseGoesOn) {
  Wire wire;
  wire.run(1.0);
  wire.go(0.4, 0.0);
  wire.run(3.0);
  wire.base.fail(DeviceFault::Reset, wire.now);
  wire.run(0.5);
  const double there = wire.truth.x;
  EXPECT_FALSE(wire.base.motors_on());
  ASSERT_TRUE(wire.run_until([&] { return wire.base.open() && wire.base.motors_on(); }, 6.0)) << wire.driver.state();
  wire.run(1.0);
  EXPECT_GT(wire.truth.x, there);
  wire.go(0.0, 0.0);
  wire.run(2.0);
  // What it rolled on unseen, half a second at most, is lost.
  EXPECT_NEAR(wire.odometry.back().pose.x, wire.truth.x, 0.3);
}

TEST(PioneerWire, ARobotThatIsStillOpenIsClosedFirst) {
  Wire wire;
  wire.run(1.0);
  ASSERT_TRUE(wire.driver.ready());
  // The client was killed without CLOSE, on a line that tells nobody.
  wire.driver = Pioneer({});
  wire.driver.opened(wire.now, LineKind::Tcp);
  EXPECT_TRUE(wire.run_until([&] { return wire.driver.ready(); }, 3.0)) << wire.driver.state();
}

TEST(PioneerWire, ARobotOfUnknownUnitsIsRefusedByName) {
  ArcosEmulatorSettings settings;
  settings.identity.subclass = "seekur";
  Wire wire(settings);
  wire.run(3.0);
  EXPECT_FALSE(wire.driver.ready());
  EXPECT_FALSE(wire.base.open());
  EXPECT_THAT(wire.driver.state(), testing::AllOf(testing::HasSubstr("'seekur'"), testing::HasSubstr("p3at-sh")));
}

TEST(PioneerWire, WhatABaseSaysOfItselfHasNoEscapesForTheTerminal) {
  ArcosEmulatorSettings settings;
  settings.identity.name = "ro\rbbie";
  settings.identity.subclass = "\x1b[31mp3at\x07";
  settings.configuration.serial = settings.configuration.firmware = "\x1b[2J";
  Wire wire(settings);
  wire.run(3.0);
  EXPECT_THAT(wire.driver.state(), testing::HasSubstr("'\\x1b[31mp3at\\x07'"));
  EXPECT_EQ(wire.driver.identity().name, "ro\\rbbie");
}

TEST(PioneerWire, ALostEchoOfASyncCostsOneMoreRound) {
  for (const int lost : {1, 2, 3}) {
    Wire wire;
    int echoes = 0;
    while (!wire.driver.ready() && wire.now < Stamp{1'700'000'010'000'000'000}) {
      wire.now = wire.now + kStep;
      wire.driver.advance(wire.now);
      wire.base.receive(wire.driver.take_output(wire.now), wire.now);
      if (++wire.steps % 100 == 0) wire.base.measure({wire.now, {}, 0.0, 0.0, false}, wire.now);
      const std::string sent = wire.base.take_output();
      if (!sent.empty() && ++echoes != lost) wire.driver.receive(sent, wire.now);
    }
    EXPECT_TRUE(wire.driver.ready()) << "echo " << lost << " lost: " << wire.driver.state();
  }
}

}  // namespace
}  // namespace rubble::robot
