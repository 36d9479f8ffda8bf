// The levelling unit's driver against its emulator, over a wire without ports or clocks.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <deque>
#include <functional>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "robot/drivers/levelling_unit.h"
#include "robot/emulators/levelling_emulator.h"
#include "robot/emulators/line_faults.h"

namespace rubble::robot {
namespace {

constexpr double kGravity = 9.80665;
constexpr double kUnitStep = 0.001;  // [s]

class UnitWire {
 public:
  explicit UnitWire(LevellingEmulatorSettings emulator = {}, LevellingUnitSettings settings = {})
      : unit(emulator), driver(settings) {
    unit.client_came(now);
    driver.opened(now, LineKind::Uart);
  }

  void run(double seconds) {
    for (const Stamp end = now + seconds; now < end;) step();
  }

  void step() {
    now = now + kUnitStep;
    driver.advance(now);
    const std::string to_unit = driver.take_output(now);
    if (!cut && !deaf) unit.receive(to_unit, now);
    unit.advance(now);
    if (++steps % 20 == 0) unit.measure(felt, {now, unit.aim().pitch, unit.aim().roll}, now);
    for (const std::string& piece : faults.pass(unit.take_output(), now))
      if (!cut) on_its_way.emplace_back(now + slow, piece);
    for (; !on_its_way.empty() && on_its_way.front().first <= now; on_its_way.pop_front())
      driver.receive(on_its_way.front().second, now);
    for (const Acceleration& a : driver.take_accelerations()) accelerations.push_back(a);
    for (const AimState& a : driver.take_aims()) aims.push_back(a);
  }

  Stamp now{1'700'000'000'000'000'000};
  LevellingEmulator unit;
  LevellingUnit driver;
  LineFaults faults{2};
  Acceleration felt;
  std::vector<Acceleration> accelerations;
  std::vector<AimState> aims;
  bool cut = false;
  bool deaf = false;  ///< the unit, to the driver
  double slow = 0.0;  ///< the unit's bytes take so long [s]
  std::deque<std::pair<Stamp, std::string>> on_its_way;
  int steps = 0;
};

/// By late reports the platform would swing instead of levelling, and they carry no age of their own.
TEST(LevellingWire, HowLateTheUnitAnswersIsMeasured) {
  for (const double slow : {0.0, 0.2, 0.4, 1.0}) {
    for (const bool from_the_start : {true, false}) {
      UnitWire wire;
      if (from_the_start) wire.slow = slow;
      wire.run(2.0 + 3.0 * slow);
      wire.slow = slow;
      wire.run(3.0 + 3.0 * slow);
      EXPECT_TRUE(wire.driver.ready());
      EXPECT_NEAR(wire.driver.answers(wire.now).late, slow, 0.02);
      wire.slow = 0.0;
      wire.run(slow + 3.0);
      EXPECT_LT(wire.driver.answers(wire.now).late, 0.02);
    }
  }
  for (const ByteFault fault :
       {ByteFault::Lost, ByteFault::Split, ByteFault::Doubled, ByteFault::Junk, ByteFault::WrongSum}) {
    SCOPED_TRACE(static_cast<int>(fault));
    UnitWire wire;
    wire.run(2.0);
    wire.faults.spoil(fault, wire.now + 1.0);
    for (int i = 0; i < 40; ++i) {
      wire.run(0.1);
      ASSERT_LT(wire.driver.answers(wire.now).late, 0.3) << "a spoilt second is no slow line";
    }
  }
}

/// Nobody drives off before it is known how slow the line is.
TEST(LevellingWire, AUnitThatIsLateFromTheStartIsNeverTakenForQuick) {
  const double permitted = 0.25;
  for (const double slow : {0.3, 0.4, 0.6, 0.9, 1.3, 2.0}) {
    SCOPED_TRACE(slow);
    UnitWire wire;
    wire.slow = slow;
    for (int i = 0; i < 9000; ++i) {
      wire.step();
      ASSERT_FALSE(wire.driver.ready() && wire.driver.answers(wire.now).late <= permitted)
          << "after " << 1e-3 * i << " s";
    }
    EXPECT_TRUE(wire.driver.ready());
    EXPECT_NEAR(wire.driver.answers(wire.now).late, slow, 0.02);
  }
}

/// It is driven with all the same, a while later.
TEST(LevellingWire, AUnitThatDoesNotKnowTheQuestionIsReadyInTheEnd) {
  UnitWire wire;
  wire.deaf = true;
  wire.run(AnswerTimer::kUnable - 1.0);
  EXPECT_NE(wire.driver.last_report(), Stamp::never());
  EXPECT_FALSE(wire.driver.ready());
  wire.run(2.0);
  EXPECT_TRUE(wire.driver.ready());
}

TEST(LevellingWire, AUnitThatReportsButDoesNotHearIsToldFromOneThatDoes) {
  UnitWire wire;
  wire.run(1.0);
  wire.deaf = true;
  wire.run(2.0);
  EXPECT_TRUE(wire.driver.ready());
  EXPECT_TRUE(wire.driver.answers(wire.now).missing);
  wire.deaf = false;
  wire.run(2.0);
  EXPECT_FALSE(wire.driver.answers(wire.now).missing);
  EXPECT_LT(wire.driver.answers(wire.now).late, 0.02);
}

TEST(LevellingWire, WhoOnlyListensToAUnitTellsItNothing) {
  LevellingUnitSettings passive;
  passive.passive = true;
  UnitWire wire({}, passive);
  wire.run(3.0);
  EXPECT_TRUE(wire.driver.ready());
  EXPECT_FALSE(wire.unit.servos_on());
  EXPECT_EQ(wire.driver.answers(wire.now).late, 0.0);
}

TEST(LevellingWire, TiltsArriveWithinATick) {
  UnitWire wire;
  const double pitch = deg_to_rad(10.0), roll = deg_to_rad(-5.0);
  wire.felt = {{}, kGravity * std::sin(pitch), kGravity * std::sin(roll) * std::cos(pitch)};
  wire.run(2.0);
  ASSERT_TRUE(wire.driver.ready()) << wire.driver.state();
  // A tick of 20,000 (two periods) is 0.4 mg.
  EXPECT_NEAR(wire.accelerations.back().x, wire.felt.x, kGravity * 0.0004);
  EXPECT_NEAR(wire.accelerations.back().y, wire.felt.y, kGravity * 0.0004);
  EXPECT_NEAR(static_cast<double>(wire.accelerations.size()), 100.0, 6.0);
}

/// What passes the line's sum all the same: two figures doubled that are alike.
TEST(LevellingWire, AReportThatCannotBeTrueIsDroppedAndSpoilsNoStamp) {
  UnitWire wire;
  wire.run(2.0);
  LevellingReport report;
  report.t1x = report.t1y = 10000;
  report.t2 = 20000;
  report.sequence = 110;
  report.time_us = 2'100'000;
  const std::vector<std::function<void(LevellingReport&)>> damages{
      [](LevellingReport& r) { r.t2 = 200'000'000; }, [](LevellingReport& r) { r.t2 = 2000; },
      [](LevellingReport& r) { r.t1x = 100'000; },    [](LevellingReport& r) { r.t1y = 1000; },
      [](LevellingReport& r) { r.pitch_us = 5500; },  [](LevellingReport& r) { r.time_us = 211'000'000; }};
  for (std::size_t i = 0; i < damages.size(); ++i) {
    SCOPED_TRACE(i);
    LevellingReport damaged = report;
    damages[i](damaged);
    wire.driver.receive(levelling_line(body(damaged)), wire.now);
    wire.accelerations.clear();
    wire.run(0.5);
    ASSERT_GT(wire.accelerations.size(), 20u);
    for (const Acceleration& felt : wire.accelerations) EXPECT_LT(std::abs(felt.x) + std::abs(felt.y), 0.1);
    EXPECT_LT(wire.now - wire.accelerations.back().stamp, 0.05);
  }
  EXPECT_EQ(wire.driver.bad_lines(), damages.size() - 1) << "another time is one of a unit that was reset";
}

/// Whatever of it passes the sums.
TEST(LevellingWire, StampsAreRightAgainAfterAnyDamage) {
  double worst = 0.0;
  for (const ByteFault fault : {ByteFault::Lost, ByteFault::Doubled, ByteFault::Junk}) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
      UnitWire wire;
      wire.faults = LineFaults(seed);
      wire.run(1.0);
      wire.faults.spoil(fault, wire.now + 1.0);
      wire.run(2.0);
      const double late = wire.now - wire.accelerations.back().stamp;
      worst = std::max(worst, late);
      ASSERT_LT(late, 0.05) << "fault " << static_cast<int>(fault) << ", seed " << seed;
    }
  }
  std::cout << "newest stamp a second after the damage: " << 1e3 * worst << " ms old at most\n";
}

TEST(LevellingWire, APartsOwnZeroAndSensitivityAreTakenOut) {
  LevellingEmulatorSettings part;
  part.zero_x = 0.57;
  part.zero_y = 0.44;
  part.sensitivity = 0.131;
  LevellingUnitSettings calibrated;
  calibrated.x = {0.57, 0.131};
  calibrated.y = {0.44, 0.131};
  UnitWire wire(part, calibrated);
  wire.felt = {{}, 1.0, -2.0};
  wire.run(1.0);
  EXPECT_NEAR(wire.accelerations.back().x, 1.0, 0.005);
  EXPECT_NEAR(wire.accelerations.back().y, -2.0, 0.005);
}

TEST(LevellingWire, ServosTakeTheAnglesAndTellThem) {
  UnitWire wire;
  wire.run(1.0);
  wire.driver.aim({deg_to_rad(9.0), deg_to_rad(-4.5)});
  wire.run(0.2);
  EXPECT_TRUE(wire.unit.servos_on());
  EXPECT_NEAR(wire.unit.aim().pitch, deg_to_rad(9.0), deg_to_rad(0.05));
  EXPECT_NEAR(wire.aims.back().roll, deg_to_rad(-4.5), deg_to_rad(0.05));
  wire.driver.aim({deg_to_rad(80.0), 0.0});
  wire.run(0.2);
  EXPECT_NEAR(wire.unit.aim().pitch, deg_to_rad(54.0), deg_to_rad(0.1));  // 2100 us
}

TEST(LevellingWire, WithoutACommandTheServosHold) {
  UnitWire wire;
  wire.run(1.0);
  wire.driver.aim({deg_to_rad(9.0), 0.0});
  wire.run(1.0);
  EXPECT_NEAR(wire.unit.aim().pitch, deg_to_rad(9.0), deg_to_rad(0.05));
  wire.cut = true;
  wire.run(1.0);
  wire.unit.receive(levelling_line("S,1500,1500"), wire.now);
  wire.unit.take_output();
  wire.run(0.01);
  EXPECT_NEAR(wire.unit.aim().pitch, 0.0, deg_to_rad(0.05)) << "the first command after the watchdog is obeyed";
}

TEST(LevellingWire, TheWatchdogsFlagIsRaised) {
  LevellingEmulator unit({});
  Stamp now{0};
  unit.client_came(now);
  unit.receive(levelling_line("E,1") + levelling_line("W,500"), now);
  unit.take_output();
  LevellingLines lines;
  int flags = 0;
  for (int i = 0; i < 40; ++i) {
    now = now + 0.02;
    unit.advance(now);
    unit.measure({}, {}, now);
    lines.feed(unit.take_output());
    while (const auto fields = lines.next())
      if (const auto report = parse_report(*fields)) flags = report->flags;
    const bool tripped = (flags & LevellingReport::kWatchdog) != 0;
    if (now.seconds() < 0.49) {
      EXPECT_FALSE(tripped) << now.seconds();
    }
    if (now.seconds() > 0.53) {
      EXPECT_TRUE(tripped) << now.seconds();
    }
  }
}

TEST(LevellingWire, AResetUnitIsSetUpAgain) {
  UnitWire wire;
  wire.run(1.0);
  wire.unit.fail(DeviceFault::Reset, wire.now);
  EXPECT_FALSE(wire.unit.servos_on());
  wire.run(0.2);
  EXPECT_TRUE(wire.unit.servos_on());
  EXPECT_TRUE(wire.driver.ready());
}

TEST(LevellingWire, ADeadSensorIsSilentButTold) {
  UnitWire wire;
  wire.run(1.0);
  wire.unit.fail(DeviceFault::Sensor, wire.now);
  wire.run(0.1);
  const std::size_t before = wire.accelerations.size();
  wire.run(0.5);
  EXPECT_EQ(wire.accelerations.size(), before);
  EXPECT_TRUE(wire.driver.sensor_fault());
  wire.run(1.0);
  EXPECT_GT(wire.accelerations.size(), before);
}

TEST(LevellingWire, WithADeadSensorTheServosHold) {
  UnitWire wire;
  wire.run(1.0);
  wire.driver.aim({deg_to_rad(9.0), 0.0});
  wire.run(0.5);
  wire.unit.fail(DeviceFault::Sensor, wire.now);
  wire.run(0.1);
  wire.driver.aim({deg_to_rad(-9.0), 0.0});
  wire.run(0.3);
  EXPECT_NEAR(wire.unit.aim().pitch, deg_to_rad(9.0), deg_to_rad(0.05)) << "an angle that nothing has measured";
  wire.run(1.0);
  wire.driver.aim({deg_to_rad(-9.0), 0.0});
  wire.run(0.3);
  EXPECT_NEAR(wire.unit.aim().pitch, deg_to_rad(-9.0), deg_to_rad(0.05));
}

TEST(LevellingWire, DamagedLinesAreNeverMeasurements) {
  for (const ByteFault fault :
       {ByteFault::Lost, ByteFault::Split, ByteFault::Doubled, ByteFault::Junk, ByteFault::WrongSum}) {
    SCOPED_TRACE(static_cast<int>(fault));
    UnitWire wire;
    wire.felt = {{}, 1.0, -1.0};
    wire.run(1.0);
    wire.faults.spoil(fault, wire.now + 1.0);
    wire.run(2.0);
    ASSERT_TRUE(wire.driver.ready());
    for (const Acceleration& a : wire.accelerations) EXPECT_NEAR(a.x, 1.0, 0.01);
    for (std::size_t i = 1; i < wire.accelerations.size(); ++i)
      ASSERT_GT(wire.accelerations[i].stamp, wire.accelerations[i - 1].stamp);
  }
}

TEST(LevellingEmulator, ARateThatItsMeasurementsDoNotAllowIsClippedAndSaidSo) {
  LevellingEmulatorSettings settings;
  settings.most_rate = 50;
  LevellingEmulator unit(settings);
  Stamp now{0};
  unit.client_came(now);
  for (const int asked : {100, 50, 20}) {
    unit.take_output();
    unit.receive(levelling_line("R," + std::to_string(asked)), now);
    EXPECT_EQ(unit.take_output(), levelling_line(asked > 50 ? "N,RANGE" : "R,OK"));
    LevellingLines lines;
    for (int i = 0; i < 100; ++i) {
      now = now + 0.02;
      unit.measure({now, 0.0, 0.0}, {now, 0.0, 0.0}, now);
      unit.advance(now);
      lines.feed(unit.take_output());
    }
    int reports = 0;
    while (const auto fields = lines.next()) reports += parse_report(*fields) ? 1 : 0;
    EXPECT_NEAR(reports, 2 * std::min(asked, 50), 2) << asked;
  }
}

TEST(LevellingEmulator, AnswersWhatItDoesNotKnow) {
  LevellingEmulator unit({});
  unit.client_came({0});
  unit.take_output();
  unit.receive(
      "$Q,1*"
      "2C\r\n",
      {0});
  EXPECT_EQ(unit.take_output(), "$N,BADSUM*6E\r\n");
  unit.receive(levelling_line("Q,1"), {0});
  EXPECT_EQ(unit.take_output(), levelling_line("N,UNKNOWN"));
  unit.receive(levelling_line("S,5000,1500"), {0});
  EXPECT_EQ(unit.take_output(), levelling_line("N,RANGE"));
}

}  // namespace
}  // namespace rubble::robot
