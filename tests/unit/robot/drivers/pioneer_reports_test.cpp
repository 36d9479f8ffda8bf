// What the Pioneer's driver makes of the reports: odometry, stamps, and the turn rates that it dithers.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/planar.h"
#include "tests/support/pioneer_wire.h"

namespace rubble::robot {
namespace {

TEST(PioneerWire, NothingMovesBeforeTheMotorsAreOn) {
  Wire wire;
  wire.run(1.0);
  wire.driver.drive({0.5, 0.5});
  wire.run(1.0);
  EXPECT_EQ(wire.truth.x, 0.0);
  wire.go(0.3, 0.0);
  wire.run(2.0);
  EXPECT_GT(wire.truth.x, 0.3);
  wire.driver.enable(false);
  wire.run(0.5);
  const double there = wire.truth.x;
  wire.run(1.0);
  EXPECT_EQ(wire.truth.x, there);
}

TEST(PioneerWire, OdometryFollowsTheWheels) {
  Wire wire;
  wire.run(1.0);
  wire.go(0.4, 0.5);
  wire.run(20.0);
  wire.go(-0.2, -0.8);
  wire.run(10.0);
  wire.go(0.0, 0.0);
  wire.run(2.0);
  const auto& last = wire.odometry.back();
  // Each report is rounded to whole millimetres and 4096ths; differences of rounded numbers do not add up.
  EXPECT_NEAR(last.pose.x, wire.truth.x, 2e-3);
  EXPECT_NEAR(last.pose.y, wire.truth.y, 2e-3);
  EXPECT_NEAR(wrap_angle(last.pose.phi - wire.truth.phi), 0.0, 2e-3);
}

TEST(PioneerWire, CoordinatesThatRollOverGoOn) {
  ArcosEmulatorSettings settings;
  settings.odometry_start = {65.5, -0.03, deg_to_rad(178.0)};
  Wire wire(settings);
  wire.run(1.0);
  wire.go(-0.5, 0.1);
  wire.run(10.0);
  wire.go(0.0, 0.0);
  wire.run(2.0);
  EXPECT_NEAR(wire.odometry.back().pose.x, wire.truth.x, 3e-3);
  EXPECT_NEAR(wire.odometry.back().pose.y, wire.truth.y, 3e-3);
  EXPECT_EQ(wire.driver.jumps(), 0u);
  EXPECT_GT(length(wire.truth.x, wire.truth.y), 2.0);
}

TEST(PioneerWire, AnOriginSetAnewIsNoMotion) {
  Wire wire;
  wire.run(1.0);
  wire.go(0.4, 0.0);
  wire.run(5.0);
  wire.base.fail(DeviceFault::SetOrigin, wire.now);
  wire.run(5.0);
  wire.go(0.0, 0.0);
  wire.run(2.0);
  EXPECT_EQ(wire.driver.jumps(), 1u);
  EXPECT_NEAR(wire.odometry.back().pose.x, wire.truth.x, 0.02);
  EXPECT_NEAR(wire.odometry.back().pose.y, 0.0, 0.02);
}

TEST(PioneerWire, SlowTurnsAreRightInTheMean) {
  for (const double wanted : {0.3, 1.1, -2.47, 6.6}) {
    Wire wire;
    wire.run(1.0);
    wire.go(0.0, deg_to_rad(wanted));
    wire.run(1.0);
    for (int i = 0; i < 8; ++i) {
      const double before = wire.truth.phi;
      wire.run(1.0);
      EXPECT_NEAR(rad_to_deg(wire.truth.phi - before), wanted, 0.1);
    }
  }
}

TEST(PioneerWire, DamagedLinesNeitherMoveThePoseNorStopTheReports) {
  for (const ByteFault fault :
       {ByteFault::Lost, ByteFault::Split, ByteFault::Doubled, ByteFault::Junk, ByteFault::WrongSum}) {
    SCOPED_TRACE(static_cast<int>(fault));
    Wire wire;
    wire.run(1.0);
    wire.go(0.3, 0.3);
    wire.run(3.0);
    wire.faults.spoil(fault, wire.now + 1.0);
    wire.run(3.0);
    wire.go(0.0, 0.0);
    wire.run(2.0);
    ASSERT_TRUE(wire.driver.ready());
    EXPECT_NEAR(wire.odometry.back().pose.x, wire.truth.x, 0.01);
    EXPECT_NEAR(wire.odometry.back().pose.y, wire.truth.y, 0.01);
    EXPECT_NEAR(wrap_angle(wire.odometry.back().pose.phi - wire.truth.phi), 0.0, 0.01);
  }
}

TEST(PioneerWire, NoMotionIsLostInAGapOfTheReports) {
  Wire wire;
  wire.run(1.0);
  wire.go(0.2, 1.0);
  wire.run(3.0);
  wire.cut = true;
  wire.run(1.7);
  wire.cut = false;
  wire.run(1.0);
  wire.go(0.0, 0.0);
  wire.run(2.0);
  EXPECT_EQ(wire.driver.jumps(), 0u);
  EXPECT_NEAR(wrap_angle(wire.odometry.back().pose.phi - wire.truth.phi), 0.0, 0.01);
  EXPECT_NEAR(wire.odometry.back().pose.x, wire.truth.x, 0.01);
}

TEST(PioneerWire, ReportsThatArriveTogetherKeepTheirTimes) {
  // Held up on the line, or waiting in a computer that was busy for six seconds.
  for (const int held : {5, 60}) {
    SCOPED_TRACE(held);
    Wire wire;
    wire.run(2.0);
    wire.odometry.clear();
    std::string waiting;
    std::vector<Stamp> sent;
    for (int i = 0; i < held; ++i) {
      wire.now = wire.now + kCycle;
      wire.base.measure({wire.now, {}, 0.0, 0.0, false}, wire.now);
      waiting += wire.base.take_output();
      sent.push_back(wire.now);
    }
    wire.driver.receive(waiting, wire.now);
    const auto odometry = wire.driver.take_odometry();
    ASSERT_EQ(odometry.size(), sent.size());
    for (std::size_t i = 0; i < sent.size(); ++i) EXPECT_NEAR(odometry[i].stamp - sent[i], 0.0, 2e-3) << i;
  }
}

TEST(PioneerWire, StallsAreTold) {
  Wire wire;
  wire.run(1.0);
  wire.base.fail(DeviceFault::Stall, wire.now);
  wire.run(0.3);
  EXPECT_TRUE(wire.odometry.back().stalled);
  wire.run(1.5);
  EXPECT_FALSE(wire.odometry.back().stalled);
}

TEST(PioneerWire, AnOlderControllersUnitsAreTakenIntoAccount) {
  for (const auto& [subclass, millimetres] : {std::pair("p3at", 0.465), std::pair("p3dx", 0.485)}) {
    ArcosEmulatorSettings settings;
    settings.identity.subclass = subclass;
    Wire wire(settings);
    wire.run(1.0);
    wire.go(0.0, 0.0);
    const double before = wire.odometry.back().pose.x;
    // The emulator counts in millimetres; this controller's count is shorter.
    wire.truth.x += 0.02;
    wire.run(0.2);
    EXPECT_NEAR(wire.odometry.back().pose.x - before, 0.02 * millimetres, 1e-6) << subclass;
  }
}

/// Reports are stamped with the moment they left, whatever the line: only an UART's bytes take their time.
class ReportsOn : public testing::TestWithParam<LineKind> {};

TEST_P(ReportsOn, HaveTheStampOfTheirMoment) {
  Stamp now{1'700'000'000'000'000'000};
  Pioneer driver{BaseSettings{}};
  driver.opened(now, GetParam());
  ArcosEmulator base{ArcosEmulatorSettings{}};
  std::vector<std::pair<Stamp, std::string>> on_their_way;
  std::vector<Stamp> left, stamps;
  Stamp line_free = now;
  for (int i = 0; i < 4000; ++i, now = now + kStep) {
    driver.advance(now);
    base.receive(driver.take_output(now), now);
    if (i % 100 == 0) {
      base.measure({now, {}, 0.0, 0.0, false}, now);
      if (base.open()) left.push_back(now);
    }
    const std::string sent = base.take_output();
    // What the line does to them, as docs/hardware.md says: 10 bits a byte, here at 9600 baud.
    const double way = GetParam() == LineKind::Uart ? 10.0 * static_cast<double>(sent.size()) / 9600.0 : 0.0;
    line_free = (line_free < now ? now : line_free) + way;
    if (!sent.empty()) on_their_way.emplace_back(line_free, sent);
    while (!on_their_way.empty() && on_their_way.front().first <= now) {
      driver.receive(on_their_way.front().second, now);
      on_their_way.erase(on_their_way.begin());
    }
    for (const Odometry& o : driver.take_odometry()) stamps.push_back(o.stamp);
  }
  ASSERT_GT(stamps.size(), 20u);
  ASSERT_LE(stamps.size(), left.size());
  left.resize(stamps.size());
  // The first ones wait behind the configuration, which takes 0.15 s at 9600 baud.
  for (std::size_t i = 3; i < stamps.size(); ++i) EXPECT_NEAR(stamps[i] - left[i], 0.0, 1.1 * kStep) << i;
}

std::string name_of(const testing::TestParamInfo<LineKind>& info) {
  constexpr const char* kNames[] = {"Tcp", "Pty", "Usb", "Uart"};
  return kNames[static_cast<int>(info.param)];
}

INSTANTIATE_TEST_SUITE_P(EveryLine, ReportsOn,
                         testing::Values(LineKind::Tcp, LineKind::Pty, LineKind::Usb, LineKind::Uart), name_of);

TEST(PioneerWire, ADamagedLengthCostsOneReportAndShiftsNone) {
  Wire wire;
  wire.run(2.0);
  wire.odometry.clear();
  std::vector<Stamp> sent;
  for (int i = 0; i < 12; ++i) {
    wire.now = wire.now + kCycle;
    wire.base.measure({wire.now, {}, 0.0, 0.0, false}, wire.now);
    std::string report = wire.base.take_output();
    if (i == 3) report[2] = static_cast<char>(190);
    wire.driver.receive(report, wire.now);
    if (i != 3) sent.push_back(wire.now);
  }
  const auto odometry = wire.driver.take_odometry();
  ASSERT_EQ(odometry.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) EXPECT_NEAR(odometry[i].stamp - sent[i], 0.0, 2e-3) << i;
}

}  // namespace
}  // namespace rubble::robot
