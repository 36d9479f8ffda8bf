// Scans in the stream of a simulated base's reports, as clients of MobileSim ask for them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "robot/emulators/arcos_emulator.h"
#include "robot/model.h"

namespace rubble::robot {
namespace {

using namespace arcos;

constexpr Stamp kStart{1'700'000'000'000'000'000};

/// An open session of a base whose scanner sees 1 m + 10 mm a degree to the left, and nothing from 100 deg on.
class SimLaserTest : public testing::Test {
 protected:
  SimLaserTest() : base_(settings()) {
    base_.client_came(kStart);
    for (const Command number : {kSync0, kSync1, kSync2, kOpen}) base_.receive(command(number), kStart);
    base_.take_output();
    LaserModel laser;
    scan_.stamp = kStart;
    scan_.angle_min = laser.angle_min;
    scan_.angle_step = laser.angle_step;
    scan_.beam_period = laser.beam_period;
    for (std::size_t i = 0; i < static_cast<std::size_t>(laser.beams); ++i) {
      const double degrees = rad_to_deg(scan_.bearing(i));
      scan_.ranges.push_back(degrees > 100.0 ? std::numeric_limits<float>::infinity()
                                             : static_cast<float>(1.0 + 0.001 * std::floor(10.0 * degrees)));
    }
  }
  static ArcosEmulatorSettings settings() {
    ArcosEmulatorSettings settings;
    settings.true_start = {1.25, -0.5, 0.5};
    return settings;
  }

  std::vector<std::string> after(const std::vector<std::string>& commands, Stamp now = kStart + 0.1) {
    for (const std::string& packet : commands) base_.receive(packet, now);
    base_.measure(scan_);
    base_.advance(now);
    PacketParser parser;
    parser.feed(base_.take_output());
    std::vector<std::string> payloads;
    while (auto payload = parser.next()) payloads.push_back(*payload);
    return payloads;
  }

  /// The readings of all payloads by their numbers; checks what frames them.
  static std::map<int, int> readings(const std::vector<std::string>& payloads, bool extended) {
    std::map<int, int> all;
    for (const std::string& payload : payloads) {
      Fields fields(payload);
      EXPECT_EQ(fields.u8(), extended ? 0x61 : 0x60);
      if (!extended) fields.skip(6);
      const int total = fields.u16(), first = fields.u16(), count = fields.u8();
      EXPECT_LE(count, 32);
      for (int i = 0; i < count; ++i) {
        all[first + i] = fields.u16();
        if (extended) fields.skip(3);
      }
      EXPECT_EQ(fields.left(), extended ? 2u : 0u);
      EXPECT_LE(first + count, total);
    }
    return all;
  }

  ArcosEmulator base_;
  LaserScan scan_;
};

TEST_F(SimLaserTest, NobodyIsSentAScanThatHeDidNotAskFor) { EXPECT_THAT(after({}), testing::IsEmpty()); }

TEST_F(SimLaserTest, ReadingsAreThoseOfTheBearingsAskedFor) {
  for (const bool extended : {false, true}) {
    const auto all = readings(after({command(kSimLaserStart, -90), command(kSimLaserEnd, 90),
                                     command(kSimLaserStep, 100), command(kSimLaserEnable, extended ? 2 : 1)}),
                              extended);
    ASSERT_EQ(all.size(), 181u);
    for (int i = 0; i < 181; ++i) EXPECT_NEAR(all.at(i), 1000 + 10 * (i - 90), 3) << i;  // half a step of the scanner
  }
}

TEST_F(SimLaserTest, OlderNumbersMeanTheSameAndASweepMayGoTheOtherWay) {
  const auto all = readings(after({command(kOldLaserStart, 90), command(kOldLaserEnd, -90), command(kOldLaserStep, 50),
                                   command(kOldLaserEnable, 2)}),
                            true);
  ASSERT_EQ(all.size(), 361u);
  EXPECT_NEAR(all.at(0), 1900, 3);
  EXPECT_NEAR(all.at(360), 100, 3);
}

TEST_F(SimLaserTest, WhatIsNotSeenIsFarAway) {
  const auto all =
      readings(after({command(kSimLaserStart, -180), command(kSimLaserEnd, 180), command(kSimLaserEnable, 1)}), false);
  ASSERT_EQ(all.size(), 361u);
  EXPECT_EQ(all.at(0), 32000);    // behind it
  EXPECT_EQ(all.at(290), 32000);  // 110 deg: nothing in range
  EXPECT_NEAR(all.at(180), 1000, 3);
}

TEST_F(SimLaserTest, AScanIsSentOnceItIsOver) {
  EXPECT_THAT(after({command(kSimLaserEnable, 1)}, kStart + 0.05), testing::IsEmpty());
  base_.advance(kStart + 0.1);
  EXPECT_FALSE(base_.take_output().empty());
}

TEST_F(SimLaserTest, ResetPutsItBackAndItsOdometryToZero) {
  base_.measure(Odometry{kStart + 0.1, {3.0, 2.0, 1.0}, 0.0, 0.0, false}, kStart + 0.1);
  base_.take_output();
  after({command(kSimReset)});
  const auto placed = base_.take_placed();
  ASSERT_TRUE(placed);
  EXPECT_EQ(placed->x, 1.25);
  EXPECT_EQ(placed->phi, 0.5);
  base_.measure(Odometry{kStart + 0.2, {3.0, 2.0, 1.0}, 0.0, 0.0, false}, kStart + 0.2);
  PacketParser parser;
  parser.feed(base_.take_output());
  const auto report = parse_information(parser.next().value_or(""));
  ASSERT_TRUE(report);
  EXPECT_EQ(report->x, 0);
  EXPECT_EQ(report->y, 0);
  EXPECT_EQ(report->heading, 0);
}

TEST_F(SimLaserTest, StatusComesOnceWithoutArgumentAndBeforeTheReport) {
  base_.receive(command(kSimStat), kStart);
  const auto types = [&] {
    base_.measure(Odometry{kStart + 0.1, {}, 0.0, 0.0, false}, kStart + 0.1);
    PacketParser parser;
    parser.feed(base_.take_output());
    std::vector<int> all;
    while (const auto payload = parser.next()) all.push_back(static_cast<std::uint8_t>(payload->front()));
    return all;
  };
  EXPECT_THAT(types(), testing::ElementsAre(0x62, 0x32));
  EXPECT_THAT(types(), testing::ElementsAre(0x32));
}

TEST_F(SimLaserTest, TheSimulatorTellsWhoItIs) {
  const auto payloads = after({command(kSimControl, 6)});
  ASSERT_EQ(payloads.size(), 1u);
  Fields fields(payloads[0]);
  EXPECT_EQ(fields.u8(), 0x63);
  EXPECT_EQ(fields.text(), "MobileSim");
  EXPECT_EQ(fields.text(), "S.0");
  EXPECT_EQ(fields.i32(), 0);
  ASSERT_EQ(fields.i32(), 1);
  EXPECT_EQ(fields.text(), "laser");
}

}  // namespace
}  // namespace rubble::robot
