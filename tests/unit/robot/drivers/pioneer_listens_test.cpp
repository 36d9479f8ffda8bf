// The Pioneer's driver beside somebody else who drives.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/planar.h"
#include "robot/drivers/black_box_replay.h"
#include "tests/support/pioneer_wire.h"

namespace rubble::robot {
namespace {

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

}  // namespace
}  // namespace rubble::robot
