// The Pioneer's driver against its emulator, byte by byte over a wire without ports or clocks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "base/planar.h"
#include "robot/drivers/black_box_replay.h"
#include "robot/drivers/pioneer.h"
#include "robot/emulators/arcos_emulator.h"
#include "robot/emulators/line_faults.h"

namespace rubble::robot {
namespace {

constexpr double kStep = 0.001;  // [s]
constexpr double kCycle = 0.1;   // of the reports [s]

/// A robot whose wheels do what the emulator asks, exactly.
class Wire {
 public:
  explicit Wire(ArcosEmulatorSettings emulator = {}, BaseSettings settings = {}) : base(emulator), driver(settings) {
    base.client_came(now);
    driver.opened(now, LineKind::Tcp);
  }

  void run(double seconds) {
    for (const Stamp end = now + seconds; now < end;) step();
  }

  /// Until it is true, at most so long; whether it became.
  bool run_until(const std::function<bool()>& reached, double seconds) {
    for (const Stamp end = now + seconds; now < end && !reached();) step();
    return reached();
  }

  void step() {
    now = now + kStep;
    driver.advance(now);
    const std::string to_base = driver.take_output(now);
    if (!to_base.empty()) said.push_back(to_base);
    const bool heard = !cut && (!deaf_to || !deaf_to(to_base));
    if (heard && !to_base.empty() && !gets_lost()) base.receive(to_base, now);
    base.advance(now);
    const Drive& motion = base.motion();
    truth.phi += motion.w * kStep;
    truth.x += motion.v * std::cos(truth.phi) * kStep;
    truth.y += motion.v * std::sin(truth.phi) * kStep;
    ++steps;
    if (steps % 100 == 0) base.measure({now, truth, motion.v, motion.w, false}, now);
    for (const std::string& piece : faults.pass(base.take_output(), now)) {
      if (!cut && !gets_lost()) on_its_way.emplace_back(now + slow, piece);
      if (listener != nullptr) listener->receive(piece, now);
    }
    for (; !on_its_way.empty() && on_its_way.front().first <= now; on_its_way.pop_front())
      driver.receive(on_its_way.front().second, now);
    if (listener != nullptr) {
      listener->advance(now);
      said_by_listener += listener->take_output(now);
    }
    for (const Odometry& o : driver.take_odometry()) odometry.push_back(o);
  }

  bool gets_lost() {
    const bool gone = loss > 0.0 && std::uniform_real_distribution<double>()(random) < loss;
    lost += gone ? 1 : 0;
    return gone;
  }

  void go(double v, double w) {
    driver.enable(true);
    run_until([&] { return driver.motors_on(); }, 2.0);
    driver.drive({v, w});
  }

  Stamp now{1'700'000'000'000'000'000};
  ArcosEmulator base;
  Pioneer driver;
  LineFaults faults{1};
  mrpt::math::TPose2D truth;
  std::vector<Odometry> odometry;
  bool cut = false;
  std::function<bool(const std::string&)> deaf_to;  ///< packets that the base passes over
  std::vector<std::string> said;                    ///< by the driver
  double slow = 0.0;                                ///< the base's bytes take so long [s]
  std::deque<std::pair<Stamp, std::string>> on_its_way;
  double loss = 0.0;  ///< so many of the packets never arrive, either way
  std::mt19937 random{1};
  int lost = 0;
  int steps = 0;
  Pioneer* listener = nullptr;  ///< hears what the base says
  std::string said_by_listener;
};

TEST(PioneerWire, TheHandshakeEndsInReports) {
  Wire wire;
  ASSERT_TRUE(wire.run_until([&] { return wire.driver.ready(); }, 2.0)) << wire.driver.state();
  EXPECT_EQ(wire.driver.identity().subclass, "p3at-sh");
  wire.run(0.2);
  EXPECT_EQ(wire.driver.configuration().cycle_ms, 100);
  EXPECT_NEAR(wire.driver.battery(), 12.8, 1e-9);
  EXPECT_FALSE(wire.base.motors_on());
}

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

BaseSettings listening() {
  BaseSettings settings;
  settings.passive = settings.listen = true;
  return settings;
}

TEST(PioneerWire, WhoListensTellsTheMotionThatSomebodyElseDrivesAndSaysNothing) {
  Wire wire;
  wire.run(1.0);
  wire.go(0.3, 0.2);
  Pioneer listener(listening());
  listener.opened(wire.now, LineKind::Tcp);
  const mrpt::math::TPose2D before = wire.truth;
  wire.listener = &listener;
  wire.run(0.5);
  EXPECT_TRUE(listener.ready()) << listener.state();
  wire.run(4.5);
  listener.drive({0.5, 0.0});
  listener.enable(true);
  wire.run(0.5);
  const mrpt::math::TPose2D then = wire.truth;
  // The base falls silent and is opened anew, which sets its odometry to zero: that is no motion.
  wire.cut = true;
  wire.base.client_left(wire.now);
  wire.base.client_came(wire.now);
  wire.run(4.0);
  EXPECT_FALSE(listener.ready());
  const auto heard = listener.take_odometry();
  ASSERT_GT(heard.size(), 40u);
  const mrpt::math::TPose2D driven = heard.back().pose - heard.front().pose;
  EXPECT_NEAR(length(driven.x, driven.y), length(then.x - before.x, then.y - before.y), 0.04);
  wire.cut = false;
  wire.driver.opened(wire.now, LineKind::Tcp);
  wire.listener = nullptr;  // so long that it would ask who is there
  ASSERT_TRUE(wire.run_until([&] { return wire.driver.ready(); }, 3.0));
  wire.listener = &listener;
  ASSERT_TRUE(wire.run_until([&] { return listener.ready(); }, 1.0));
  const auto again = listener.take_odometry();
  ASSERT_FALSE(again.empty());
  EXPECT_NEAR(length(again.back().pose.x - heard.back().pose.x, again.back().pose.y - heard.back().pose.y), 0.0, 0.01);
  EXPECT_EQ(wire.said_by_listener, "");
  EXPECT_TRUE(listener.farewell().empty());
  listener.emergency_stop();  // this is said all the same
  wire.run(0.1);
  EXPECT_NE(wire.said_by_listener, "");
}

TEST(PioneerWire, ABaseThatNobodyElseTalksWithIsSpokenTo) {
  Wire wire;
  wire.cut = true;  // the first one says nothing
  wire.driver = Pioneer(listening());
  wire.driver.opened(wire.now, LineKind::Tcp);
  wire.cut = false;
  ASSERT_TRUE(wire.run_until([&] { return wire.driver.ready(); }, 4.0)) << wire.driver.state();
  EXPECT_EQ(wire.driver.identity().subclass, "p3at-sh");
  EXPECT_FALSE(wire.driver.farewell().empty());
}

/// Between the end of the program that drives and its next start, and over connections of the shared line.
TEST(PioneerWire, WhoHasHeardSomebodyElseNeverSpeaksAgain) {
  for (const LineKind line : {LineKind::Tcp, LineKind::Uart}) {
    Wire wire;
    wire.run(1.0);
    Pioneer listener(listening());
    listener.opened(wire.now, line);
    wire.listener = &listener;
    ASSERT_TRUE(wire.run_until([&] { return listener.ready(); }, 2.0)) << listener.state();
    wire.cut = true;
    wire.base.client_left(wire.now);
    wire.base.client_came(wire.now);
    wire.run(12.0);
    EXPECT_FALSE(listener.ready());
    EXPECT_EQ(wire.said_by_listener, "") << "it speaks while nobody else does";
    listener.opened(wire.now, line);
    wire.run(12.0);
    EXPECT_EQ(wire.said_by_listener, "") << "it forgot by losing its line that somebody else has the base";
    wire.cut = false;
    wire.driver.opened(wire.now, LineKind::Tcp);
    ASSERT_TRUE(wire.run_until([&] { return wire.driver.ready() && listener.ready(); }, 6.0)) << listener.state();
    EXPECT_EQ(wire.said_by_listener, "");
    EXPECT_TRUE(listener.farewell().empty());
  }
}

/// Nothing on the line tells when a listener gives somebody up.
TEST(PioneerWire, TheBytesThatAListenerHeardGiveTheSameOdometryAgain) {
  for (const LineKind line : {LineKind::Tcp, LineKind::Uart}) {
    for (const double gap : {2.1, 2.98, 3.02, 5.0, 11.0}) {
      SCOPED_TRACE(gap);
      Wire wire;
      wire.run(1.0);
      std::vector<BlackBoxEntry> box{
          {"base", Direction::Opened, wire.now, line == LineKind::Tcp ? "a\ntcp" : "a\nuart"}};
      ASSERT_EQ(line_kind(box.front()), line);
      Pioneer listener(listening());
      listener.opened(wire.now, line);
      wire.go(0.3, 0.2);
      for (const double seconds : {2.0, gap, 2.0}) {
        for (const Stamp end = wire.now + seconds; wire.now < end;) {
          wire.now = wire.now + kStep;
          wire.driver.advance(wire.now);
          if (const std::string out = wire.driver.take_output(wire.now); !out.empty()) wire.base.receive(out, wire.now);
          wire.base.advance(wire.now);
          const double t = wire.now - box.front().stamp;
          if (++wire.steps % 100 == 0)
            wire.base.measure({wire.now, {0.3 * t, 0.1 * t, 0.0}, 0.3, 0.0, false}, wire.now);
          const std::string said = wire.base.take_output();
          wire.driver.receive(said, wire.now);
          const bool heard = !said.empty() && seconds != gap;
          if (heard) listener.receive(said, wire.now);
          if (heard) box.push_back({"base", Direction::FromDevice, wire.now, said});
          listener.advance(wire.now);
          ASSERT_EQ(listener.take_output(wire.now), "");
        }
      }
      const std::vector<Odometry> then = listener.take_odometry();
      const std::vector<Odometry> now = replay_black_box(box, "arcos", listening(), {}).odometry;
      ASSERT_GT(then.size(), 20u);
      ASSERT_EQ(now.size(), then.size());
      for (std::size_t i = 0; i < then.size(); ++i) {
        EXPECT_EQ(now[i].stamp.ns, then[i].stamp.ns) << i;
        EXPECT_EQ(now[i].pose.x, then[i].pose.x) << i;
      }
    }
  }
}

/// A driver that opens the base in the moment in which the listener has given up waiting.
TEST(PioneerWire, AReportBetweenTheFirstQuestionsIsSomebodyElses) {
  Wire wire;
  wire.run(1.0);
  wire.base.take_output();
  wire.base.measure({wire.now, {}, 0.0, 0.0, false}, wire.now);
  wire.base.advance(wire.now + 0.1);
  const std::string report = wire.base.take_output();
  Pioneer listener(listening());
  listener.opened(wire.now, LineKind::Tcp);
  std::string said;
  const auto step = [&] {
    wire.now = wire.now + kStep;
    listener.advance(wire.now);
    said += listener.take_output(wire.now);
  };
  for (int i = 0; i < 3000 && said.empty(); ++i) step();
  ASSERT_FALSE(said.empty());
  said.clear();
  listener.receive(report, wire.now);
  for (int i = 0; i < 10000; ++i) step();
  EXPECT_EQ(said, "");
}

/// Any byte of ours would keep the set points of another program alive after its end.
TEST(PioneerWire, WhoDoesNotDriveLeavesTheBaseToItsWatchdog) {
  Wire wire({}, listening());
  ASSERT_TRUE(wire.run_until([&] { return wire.driver.ready(); }, 4.0)) << wire.driver.state();
  wire.run(0.5);
  wire.base.receive(arcos::command(arcos::kEnable, 1), wire.now);
  wire.base.receive(arcos::command(arcos::kVelocity, 200), wire.now);
  wire.run(1.5);
  ASSERT_GT(wire.base.motion().v, 0.1);
  wire.run(2.0);
  EXPECT_TRUE(wire.base.is_held());
  EXPECT_EQ(wire.base.motion().v, 0.0);
  EXPECT_TRUE(wire.driver.ready()) << "reports come on";
}

/// A deadline in the past keeps its thread from sleeping.
TEST(PioneerWire, WhoOnlyListensHasNothingToDoUntilSomethingIsMissed) {
  Wire wire;
  wire.run(1.0);
  Pioneer listener(listening());
  listener.opened(wire.now, LineKind::Tcp);
  wire.listener = &listener;
  int past = 0, soon = 0;
  for (const bool cut : {true, false, true}) {
    wire.cut = cut;
    if (cut) wire.base.client_left(wire.now), wire.base.client_came(wire.now);
    if (!cut) wire.driver.opened(wire.now, LineKind::Tcp);
    for (int i = 0; i < 1100; ++i) {
      wire.step();
      past += listener.deadline() < wire.now ? 1 : 0;
      if (listener.ready()) soon += listener.deadline() < wire.now + 0.5 ? 1 : 0;
    }
  }
  EXPECT_TRUE(listener.ready());
  EXPECT_EQ(past, 0);
  EXPECT_EQ(soon, 0);
}

TEST(PioneerWire, OnASerialLineReportsOfEveryBitRateAreListenedFor) {
  std::string report;
  {
    Wire wire;
    Pioneer listener(listening());
    wire.run(1.0);
    wire.base.take_output();
    wire.base.measure({wire.now, {}, 0.0, 0.0, false}, wire.now);
    wire.base.advance(wire.now + 0.1);
    report = wire.base.take_output();
  }
  ASSERT_FALSE(report.empty());
  for (const int baud : {9600, 38400, 19200, 115200, 57600}) {
    Pioneer listener(listening());
    Stamp now{1'700'000'000'000'000'000};
    listener.opened(now, LineKind::Uart);
    std::string said;
    for (int i = 0; i < 3000 && !listener.ready(); ++i) {
      now = now + kStep;
      if (i % 100 == 50 && listener.baud() == baud) listener.receive(report, now);
      listener.advance(now);
      said += listener.take_output(now);
    }
    EXPECT_TRUE(listener.ready()) << baud;
    EXPECT_EQ(said, "") << baud;
  }
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

/// An answer comes with the next report; what is measured is right but for so long [s].
constexpr double kHalfCycle = 0.5 * kCycle + 0.005;

/// Reports come unasked and carry no time: only answers tell how late an order to stop would be.
TEST(PioneerWire, HowLateTheBaseAnswersIsMeasured) {
  for (const double slow : {0.1, 0.4, 0.9, 1.7}) {
    SCOPED_TRACE(slow);
    Wire wire;
    wire.run(2.0);
    wire.go(0.3, 0.2);
    wire.run(3.0);
    EXPECT_LT(wire.driver.answers(wire.now).late, kHalfCycle);
    wire.slow = slow;
    wire.run(2.0 * slow + 2.5);
    EXPECT_NEAR(wire.driver.answers(wire.now).late, slow, kHalfCycle);
    EXPECT_TRUE(wire.driver.ready());
    wire.slow = 0.0;
    wire.run(slow + 3.0);
    EXPECT_LT(wire.driver.answers(wire.now).late, kHalfCycle);
    EXPECT_EQ(wire.driver.jumps(), 0u);
  }
}

TEST(PioneerWire, ABaseThatReportsButDoesNotHearIsToldFromOneThatDoes) {
  Wire wire;
  wire.run(2.0);
  wire.go(0.3, 0.0);
  wire.run(2.0);
  wire.base.fail(DeviceFault::Watchdog, wire.now);
  wire.run(2.0);
  EXPECT_TRUE(wire.driver.ready());
  EXPECT_TRUE(wire.driver.answers(wire.now).missing);
  EXPECT_GT(wire.driver.answers(wire.now).late, AnswerTimer::kMissing);
  wire.run(3.0);
  EXPECT_FALSE(wire.driver.answers(wire.now).missing);
  EXPECT_LT(wire.driver.answers(wire.now).late, kHalfCycle);
}

/// Neither damaged answers nor the second of a doubled one are a slow line.
TEST(PioneerWire, ASpoiltSecondIsNoSlowLine) {
  for (const ByteFault fault :
       {ByteFault::Lost, ByteFault::Split, ByteFault::Doubled, ByteFault::Junk, ByteFault::WrongSum}) {
    SCOPED_TRACE(static_cast<int>(fault));
    Wire wire;
    wire.run(2.0);
    wire.go(0.3, 0.3);
    wire.run(2.0);
    wire.faults.spoil(fault, wire.now + 1.0);
    for (int i = 0; i < 4000; ++i) {
      wire.step();
      const BaseDriver::Answers answers = wire.driver.answers(wire.now);
      ASSERT_FALSE(answers.missing) << 1e-3 * i;
      ASSERT_LT(answers.late, 0.3) << 1e-3 * i;
    }
    EXPECT_LT(wire.driver.answers(wire.now).late, kHalfCycle);
  }
}

/// Five of a hundred packets get lost each way.
TEST(PioneerWire, ALineThatLosesPacketsStopsNoHealthyRobot) {
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u, 6u}) {
    SCOPED_TRACE(seed);
    Wire wire;
    wire.run(2.0);
    wire.loss = 0.05;
    wire.random.seed(seed);
    wire.go(0.3, 0.3);
    for (int i = 0; i < 120000; ++i) {
      wire.step();
      const BaseDriver::Answers answers = wire.driver.answers(wire.now);
      ASSERT_FALSE(answers.missing) << 1e-3 * i;
      ASSERT_LT(answers.late, 0.3) << 1e-3 * i;
    }
    EXPECT_GT(wire.lost, 100);
  }
}

/// A robot on a line that is slow from the start is connected, and how slow it is is known.
TEST(PioneerWire, ALineThatIsSlowFromTheStartIsNamed) {
  for (const double slow : {0.3, 0.6, 1.0, 1.6}) {
    SCOPED_TRACE(slow);
    Wire wire;
    wire.slow = slow;
    if (slow > 0.5) {
      EXPECT_TRUE(wire.run_until([&] { return wire.driver.state().find("late") != std::string::npos; }, 6.0))
          << wire.driver.state();
    }
    ASSERT_TRUE(wire.run_until([&] { return wire.driver.ready(); }, 20.0)) << wire.driver.state();
    for (int i = 0; i < 20000; ++i) {
      wire.step();
      const BaseDriver::Answers answers = wire.driver.answers(wire.now);
      ASSERT_GT(answers.late, slow - kHalfCycle) << "it was taken for quick after " << 1e-3 * i << " s";
      ASSERT_FALSE(answers.missing) << 1e-3 * i;
    }
    EXPECT_NEAR(wire.driver.answers(wire.now).late, slow, kHalfCycle);
  }
}

/// The bit rate at which the search begins, and which a Pioneer has from the factory.
TEST(PioneerWire, AtTheLowestBitRateAnswersAreTimedAndHoldUpNoReport) {
  for (const double slow : {0.0, 0.4, 1.2}) {
    SCOPED_TRACE(slow);
    Stamp now{1'700'000'000'000'000'000};
    Pioneer driver{BaseSettings{}};
    driver.opened(now, LineKind::Uart);
    ArcosEmulator base{ArcosEmulatorSettings{}};
    constexpr double kByte = 10.0 / 9600;
    const Stamp slows = now + 20.0;
    Stamp up_free = now, down_free = now;
    std::deque<std::pair<Stamp, std::string>> up, down;
    const auto put = [&](auto& way, Stamp& free, const std::string& bytes, double on_top) {
      if (bytes.empty()) return;
      free = std::max(free, now + on_top) + kByte * static_cast<double>(bytes.size());
      way.emplace_back(free, bytes);
    };
    double worst = 0.0;
    int answered = 0;
    std::vector<Odometry> odometry;
    for (int i = 0; i < 60000; ++i, now = now + kStep) {
      driver.advance(now);
      put(up, up_free, driver.take_output(now), 0.0);
      for (; !up.empty() && up.front().first <= now; up.pop_front()) base.receive(up.front().second, now);
      if (i % 100 == 0) base.measure({now, {}, 0.0, 0.0, false}, now);
      base.advance(now);
      put(down, down_free, base.take_output(), now >= slows ? slow : 0.0);
      for (; !down.empty() && down.front().first <= now; down.pop_front()) {
        answered += down.front().second.find("\xFA\xFB\x0B\x90") != std::string::npos ? 1 : 0;
        driver.receive(down.front().second, now);
      }
      for (const Odometry& o : driver.take_odometry())
        if (now < slows) odometry.push_back(o);
      if (now < slows) worst = std::max(worst, driver.answers(now).late);
    }
    EXPECT_LT(worst, 0.15) << "a line of 9600 baud is no slow one";
    EXPECT_GT(answered, 20);
    EXPECT_NEAR(driver.answers(now).late, slow, 0.1);
    ASSERT_GT(odometry.size(), 100u);
    for (std::size_t i = odometry.size() - 100; i < odometry.size(); ++i)
      EXPECT_NEAR(odometry[i].stamp - odometry[i - 1].stamp, kCycle, 0.005);
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

TEST(ArcosEmulator, MotorsThatAreSwitchedOffStopAtOnceWhateverIsSaidBehindThat) {
  for (const int behind : {arcos::kStop, arcos::kPulse, arcos::kEmergencyStop}) {
    Wire wire;
    wire.run(1.0);
    wire.go(0.4, 0.0);
    wire.run(4.0);
    wire.base.receive(arcos::command(arcos::kEnable, 0) + arcos::command(static_cast<arcos::Command>(behind)),
                      wire.now);
    wire.base.advance(wire.now + kStep);
    EXPECT_EQ(wire.base.motion().v, 0.0);
  }
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

/// The firmware wants some milliseconds between two commands.
TEST(PioneerWire, TheFarewellIsThreePacketsApart) {
  Wire wire;
  wire.run(1.0);
  EXPECT_THAT(wire.driver.farewell(),
              testing::ElementsAre(arcos::command(arcos::kStop), arcos::command(arcos::kEnable, 0),
                                   arcos::command(arcos::kClose)));
  EXPECT_GE(Device::kPause, 0.003);
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

TEST(ArcosEmulator, ASyncOutOfItsOrderStartsOver) {
  using namespace arcos;
  const auto answers = [](const std::vector<Command>& commands) {
    ArcosEmulator base{ArcosEmulatorSettings{}};
    base.client_came(Stamp{0});
    std::vector<std::string> out;
    for (const Command number : commands) {
      base.receive(command(number), Stamp{0});
      out.push_back(base.take_output());
    }
    out.emplace_back(base.open() ? "open" : "closed");
    return out;
  };
  const std::string zero = command(kSync0), one = command(kSync1);
  const std::string two = packet(encode(Identity{"MobileSim", "Pioneer", "p3at-sh"}));
  using testing::ElementsAre;
  // The second SYNC1 is no OPEN: SYNC2 has not been answered yet.
  EXPECT_THAT(answers({kSync0, kSync1, kSync1, kSync2}), ElementsAre(zero, one, "", "", "closed"));
  EXPECT_THAT(answers({kSync0, kSync2, kSync1}), ElementsAre(zero, "", "", "closed"));
  EXPECT_THAT(answers({kSync0, kSync1, kSync2, kSync2, kOpen}), ElementsAre(zero, one, two, "", "", "closed"));
  EXPECT_THAT(answers({kSync0, kSync1, kSync0, kSync1, kSync2, kOpen}),
              ElementsAre(zero, one, zero, one, two, "", "open"));
}

TEST(ArcosEmulator, OrdersToTheSidesAndToTheWholeEndEachOther) {
  Wire wire;
  wire.run(1.0);
  wire.go(0.0, 0.0);
  wire.cut = true;
  const auto say = [&](const std::string& packet) {
    for (int i = 0; i < 20; ++i) {
      wire.base.receive(i == 0 ? packet : arcos::command(arcos::kPulse), wire.now);
      wire.run(0.1);
    }
    return wire.base.motion();
  };
  const Drive turning = say(arcos::command(arcos::kWheelSpeeds, 0x050A));  // left 5, right 10
  EXPECT_NEAR(turning.v, 0.15, 1e-9);
  EXPECT_GT(turning.w, 0.1);
  const Drive straight = say(arcos::command(arcos::kVelocity, 200));
  EXPECT_NEAR(straight.v, 0.2, 1e-9);
  EXPECT_NEAR(straight.w, 0.0, 1e-9);
  const Drive sides = say(arcos::command(arcos::kWheelSpeeds, 0x0505));
  EXPECT_NEAR(sides.v, 0.1, 1e-9);
  EXPECT_NEAR(sides.w, 0.0, 1e-9);
}

TEST(ArcosEmulator, AHeadInJunkDoesNotDeafenIt) {
  Wire wire;
  wire.run(1.0);
  wire.go(0.0, 0.0);
  wire.run(0.5);
  wire.cut = true;
  wire.base.receive("\xfa\xfb\x60", wire.now);
  double moved_after = -1.0;
  for (int i = 0; i < 6000 && moved_after < 0.0; ++i) {
    if (i % 500 == 0) wire.base.receive(arcos::command(arcos::kVelocity, 200), wire.now);
    wire.step();
    if (wire.base.motion().v > 0.0) moved_after = kStep * i;
  }
  EXPECT_GE(moved_after, 0.0);
  EXPECT_LE(moved_after, 0.3);
}

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

TEST(ArcosEmulator, ARealRobotIsNoSimulator) {
  using namespace arcos;
  ArcosEmulatorSettings settings;
  play_hardware(settings);
  Wire wire(settings);
  wire.run(1.0);
  EXPECT_NE(wire.driver.identity().name, "MobileSim");
  EXPECT_NE(wire.driver.configuration().serial, "SIM");
  EXPECT_EQ(wire.driver.configuration().name, wire.driver.identity().name);
  wire.base.receive(sim_set_pose(1500, -2500, 90), wire.now);
  EXPECT_FALSE(wire.base.take_placed());
}

TEST(ArcosEmulator, SynchronisesOnlyInOrder) {
  using namespace arcos;
  ArcosEmulator base({});
  const Stamp now{0};
  base.client_came(now);
  base.receive(command(kSync1), now);
  EXPECT_EQ(base.take_output(), "");
  base.receive(command(kSync0), now);
  EXPECT_EQ(base.take_output(), command(kSync0));
  base.receive(command(kSync1), now);
  EXPECT_EQ(base.take_output(), command(kSync1));
  base.receive(command(kSync2), now);
  EXPECT_EQ(base.take_output(), packet(encode(Identity{"MobileSim", "Pioneer", "p3at-sh"})));
  base.receive(command(kOpen), now);
  EXPECT_TRUE(base.open());
}

TEST(ArcosEmulator, HeadAndMoveEndWhereTheyWereSent) {
  Wire wire;
  wire.run(1.0);
  wire.go(0.0, 0.0);
  wire.base.receive(arcos::command(arcos::kHead, -170), wire.now);
  wire.cut = true;  // the driver's own set points would take over
  for (int i = 0; i < 60; ++i) {
    wire.base.receive(arcos::command(arcos::kPulse), wire.now);
    wire.run(0.1);
  }
  EXPECT_NEAR(rad_to_deg(wrap_angle(wire.truth.phi - deg_to_rad(-170.0))), 0.0, 3.0);
  wire.base.receive(arcos::command(arcos::kMove, 500), wire.now);
  const mrpt::math::TPose2D start = wire.truth;
  for (int i = 0; i < 60; ++i) {
    wire.base.receive(arcos::command(arcos::kPulse), wire.now);
    wire.run(0.1);
  }
  EXPECT_NEAR(length(wire.truth.x - start.x, wire.truth.y - start.y), 0.5, 0.06);
}

/// What its accelerometer would feel as a blow, an explorer would take for an obstacle.
TEST(ArcosEmulator, ACableThatIsPulledOutBrakesByTheRamp) {
  Wire wire;
  wire.run(1.0);
  wire.go(0.4, 0.0);
  wire.run(3.0);
  const double v = wire.base.motion().v;
  ASSERT_NEAR(v, 0.4, 1e-3);
  wire.base.client_left(wire.now);
  EXPECT_FALSE(wire.base.brakes_hard());
  wire.base.advance(wire.now + 0.1);
  EXPECT_NEAR(wire.base.motion().v, v - 0.1 * 0.3, 2e-3);
  wire.base.advance(wire.now + 2.0);
  EXPECT_EQ(wire.base.motion().v, 0.0);
}

/// A robot that is heavy: its wheels follow the set points late, and what is measured is up to 100 ms old.
TEST(ArcosEmulator, HeadAndMoveDoNotHunt) {
  constexpr double kLag = 0.1, kStep = 0.01;
  for (const auto& [number, value] : {std::pair(arcos::kHead, 45),
                                      {arcos::kHead, -90},
                                      {arcos::kTurnBy, 30},
                                      {arcos::kMove, 500},
                                      {arcos::kMove, -500}}) {
    SCOPED_TRACE(std::to_string(number) + " " + std::to_string(value));
    ArcosEmulator base({});
    Stamp now{0};
    base.client_came(now);
    for (const auto order : {arcos::kSync0, arcos::kSync1, arcos::kSync2}) base.receive(arcos::command(order), now);
    base.receive(arcos::command(arcos::kOpen), now);
    base.receive(arcos::command(arcos::kEnable, 1), now);
    base.receive(arcos::command(number, value), now);
    const bool turns = number != arcos::kMove;
    const double goal = turns ? deg_to_rad(value) : 1e-3 * value;
    mrpt::math::TPose2D pose;
    Drive wheels;
    double farthest = 0.0, last_moved = 0.0;
    for (int i = 1; i <= 1000; ++i) {
      now = now + kStep;
      if (i % 10 == 0) base.receive(arcos::command(arcos::kPulse), now);
      base.advance(now);
      wheels.v += (base.motion().v - wheels.v) * kStep / kLag;
      wheels.w += (base.motion().w - wheels.w) * kStep / kLag;
      pose.x += wheels.v * kStep;
      pose.phi += wheels.w * kStep;
      if (i % 10 == 0) base.measure({now, pose, wheels.v, wheels.w, false}, now);
      base.take_output();
      const double there = (turns ? pose.phi : pose.x) / goal;
      farthest = std::max(farthest, there);
      if (std::abs(wheels.v) > 0.005 || std::abs(wheels.w) > deg_to_rad(0.5)) last_moved = kStep * i;
    }
    EXPECT_LT(farthest, 1.02) << "it shoots over";
    EXPECT_NEAR((turns ? pose.phi : pose.x), goal, turns ? deg_to_rad(0.4) : 0.003);
    EXPECT_LT(last_moved, 6.0) << "it never rests";
  }
}

/// A robot between two walls, told to drive or turn farther than they let it, and back whenever the order happens to
/// come.
TEST(ArcosEmulator, AWayBackFromAWallIsAsLongAsItWasSent) {
  constexpr double kLag = 0.1, kStep = 0.01, kStallTime = 0.2, kRelaxTime = 0.2;
  for (const bool turns : {false, true}) {
    for (int pushed = 0; pushed < 20; ++pushed) {
      const double wall = turns ? deg_to_rad(60.0) : 1.0, back = turns ? deg_to_rad(40.0) : 0.5;
      ArcosEmulator base({});
      Stamp now{0};
      base.client_came(now);
      for (const auto order : {arcos::kSync0, arcos::kSync1, arcos::kSync2}) base.receive(arcos::command(order), now);
      base.receive(arcos::command(arcos::kOpen), now);
      base.receive(arcos::command(arcos::kEnable, 1), now);
      base.receive(turns ? arcos::command(arcos::kHead, 120) : arcos::command(arcos::kMove, 3000), now);
      double way = 0.0, speed = 0.0, since_push = 0.0, relaxed = 0.0, turned_at = 0.0, farthest = 0.0;
      double reported = 0.0, reported_speed = 0.0;
      Stamp reported_at{0};
      bool stalled = false, ordered = false;
      int at_wall = 0;
      for (int i = 1; i <= 2500; ++i) {
        now = now + kStep;
        if (i % 10 == 0) base.receive(arcos::command(arcos::kPulse), now);
        base.advance(now);
        const double asked = relaxed > 0.0 ? 0.0 : turns ? base.motion().w : base.motion().v;
        speed += (asked - speed) * kStep / kLag;
        way += speed * kStep;
        const bool blocked = way >= wall && asked > 0.02;
        if (way >= wall) way = wall, speed = std::min(speed, 0.0);
        since_push = blocked ? since_push + kStep : 0.0;
        relaxed = std::max(0.0, relaxed - kStep);
        if (since_push > kStallTime) stalled = true, relaxed = kRelaxTime;
        if (asked < 0.0) stalled = false;
        at_wall += way >= wall ? 1 : 0;
        if (!ordered && at_wall > 13 * pushed) {
          ordered = true;
          // HEAD names a heading; MOVE counts from where the client must take the robot to be.
          turned_at = turns ? wall : reported + reported_speed * (now - reported_at);
          base.receive(turns ? arcos::command(arcos::kHead, 20) : arcos::command(arcos::kMove, -500), now);
        }
        if (ordered) farthest = std::max(farthest, turned_at - way);
        const mrpt::math::TPose2D pose = turns ? mrpt::math::TPose2D{0, 0, way} : mrpt::math::TPose2D{way, 0, 0};
        if (i % 10 == 0) {
          base.measure({now, pose, turns ? 0.0 : speed, turns ? speed : 0.0, stalled}, now);
          reported = way, reported_speed = speed, reported_at = now;
        }
        base.take_output();
      }
      SCOPED_TRACE((turns ? "turn" : "move") + std::string(", pushed for ") + std::to_string(0.13 * pushed) + " s");
      ASSERT_TRUE(ordered);
      EXPECT_LT(farthest, 1.03 * back) << "it shoots over";
      EXPECT_NEAR(turned_at - way, back, turns ? deg_to_rad(0.5) : 0.005);
    }
  }
}

/// An emulator that is open, its motors on, and a robot whose wheels follow the set points late.
struct Heavy {
  Heavy() {
    base.client_came(now);
    for (const auto order : {arcos::kSync0, arcos::kSync1, arcos::kSync2}) base.receive(arcos::command(order), now);
    base.receive(arcos::command(arcos::kOpen), now);
    base.receive(arcos::command(arcos::kEnable, 1), now);
  }
  void step() {
    constexpr double kLag = 0.1, kStep = 0.001;
    now = now + kStep;
    ++steps;
    if (steps % 500 == 0) base.receive(arcos::command(arcos::kPulse), now);
    base.advance(now);
    wheels.v += (base.motion().v - wheels.v) * kStep / kLag;
    wheels.w += (base.motion().w - wheels.w) * kStep / kLag;
    way += wheels.v * kStep;
    turn += wheels.w * kStep;
    if (steps % 100 == 0) base.measure({now, {way, 0.0, turn}, wheels.v, wheels.w, false}, now);
    base.take_output();
  }
  ArcosEmulator base{ArcosEmulatorSettings{}};
  Stamp now{0};
  Drive wheels;
  double way = 0.0, turn = 0.0;
  int steps = 0;
};

/// As clients do that say in every cycle where they want to go.
TEST(ArcosEmulator, AWayThatIsOrderedAgainAndAgainIsGone) {
  for (const int every_ms : {5, 20, 50}) {
    for (const int turn_accel : {10, 100}) {
      SCOPED_TRACE(std::to_string(every_ms) + " ms, " + std::to_string(turn_accel) + " deg/s2");
      Heavy turning;
      for (const int sign : {1, -1})
        turning.base.receive(arcos::command(arcos::kSetTurnAcceleration, sign * turn_accel), turning.now);
      for (int i = 0; i < 10000; ++i) {
        if (i % every_ms == 0) turning.base.receive(arcos::command(arcos::kHead, 90), turning.now);
        turning.step();
      }
      EXPECT_NEAR(rad_to_deg(turning.turn), 90.0, 3.0);
      Heavy driving;
      driving.base.receive(arcos::command(arcos::kSetSpeed, 300), driving.now);
      for (int i = 0; i < 4000; ++i) {
        if (i % every_ms == 0) driving.base.receive(arcos::command(arcos::kMove, 1000), driving.now);
        driving.step();
      }
      EXPECT_GT(driving.way, 0.8) << "each MOVE is a metre from where the robot is";
    }
  }
}

TEST(ArcosEmulator, MoveCountsFromWhereTheRobotIsWhenItIsOrdered) {
  for (const int late_ms : {1, 20, 50, 80, 99}) {
    SCOPED_TRACE(late_ms);
    Heavy robot;
    robot.base.receive(arcos::command(arcos::kVelocity, 300), robot.now);
    for (int i = 0; i < 3000 + late_ms; ++i) robot.step();
    ASSERT_NEAR(robot.wheels.v, 0.3, 1e-3);
    const double there = robot.way;
    robot.base.receive(arcos::command(arcos::kMove, 600), robot.now);
    for (int i = 0; i < 8000; ++i) robot.step();
    EXPECT_NEAR(robot.way - there, 0.6, 0.005);
    EXPECT_NEAR(robot.wheels.v, 0.0, 1e-3);
  }
}

TEST(ArcosEmulator, ASimulatorsClientCanSetThePose) {
  Wire wire;
  wire.run(1.0);
  wire.base.receive(arcos::sim_set_pose(1500, -2500, 90), wire.now);
  const auto placed = wire.base.take_placed();
  ASSERT_TRUE(placed);
  EXPECT_DOUBLE_EQ(placed->x, 1.5);
  EXPECT_DOUBLE_EQ(placed->y, -2.5);
  EXPECT_DOUBLE_EQ(placed->phi, deg_to_rad(90.0));
  EXPECT_FALSE(wire.base.take_placed());
}

}  // namespace
}  // namespace rubble::robot
