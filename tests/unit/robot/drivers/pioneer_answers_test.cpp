// How late a Pioneer answers, on quick, slow and lossy lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/pioneer_wire.h"

namespace rubble::robot {
namespace {

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

}  // namespace
}  // namespace rubble::robot
