// A Pioneer whose motors stay on though switched off: what it is told, and when nothing.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/pioneer_wire.h"

namespace rubble::robot {
namespace {

/// Hears nothing of what the driver says from some moment on; somebody else may drive it.
class LeftAlone : public Wire {
 public:
  explicit LeftAlone(const ArcosEmulatorSettings& emulator = {}) : Wire(emulator) {
    run(1.0);
    go(0.4, 0.0);
    run(4.0);
    deaf_to = [this](const std::string&) { return !hears; };
    driver.emergency_stop();
  }

  /// So long, `somebody` telling it to drive all the while; when something was said to it, in seconds.
  std::vector<double> watch(double seconds, bool somebody) {
    std::vector<double> when;
    const Stamp begun = now;
    while (now - begun < seconds) {
      const std::size_t before = said.size();
      if (somebody && steps % 100 == 0) base.receive(arcos::command(arcos::kVelocity, 250), now);
      step();
      if (said.size() > before) when.push_back(now - begun);
    }
    return when;
  }

  bool hears = false;
};

TEST(PioneerLeftAlone, IsToldToStopAgainAndAgainWhileItGoesOn) {
  LeftAlone wire;
  wire.watch(4.0, true);
  ASSERT_GT(wire.base.motion().v, 0.2);
  const std::size_t before = wire.said.size();
  const std::vector<double> when = wire.watch(20.0, true);
  ASSERT_EQ(when.size(), 12u) << "three packets every five seconds";
  for (std::size_t i = 0; i < when.size(); ++i)
    EXPECT_EQ(wire.said[before + i], i % 3 == 0   ? arcos::command(arcos::kEmergencyStop)
                                     : i % 3 == 1 ? arcos::command(arcos::kEnable, 0)
                                                  : arcos::command(arcos::kClose));
  for (std::size_t i = 3; i < when.size(); ++i) EXPECT_NEAR(when[i] - when[i - 3], 5.0, 0.2);
  wire.hears = true;
  wire.watch(5.5, false);
  EXPECT_FALSE(wire.base.motors_on()) << "it hears again";
  EXPECT_TRUE(wire.run_until([&] { return wire.driver.ready() && !wire.driver.motors_on(); }, 10.0));
}

TEST(PioneerLeftAlone, ThatItsWatchdogStoppedIsSwitchedOffWhenItHearsAgain) {
  LeftAlone wire;
  wire.watch(12.0, false);
  EXPECT_EQ(wire.base.motion().v, 0.0);
  ASSERT_TRUE(wire.base.motors_on());
  wire.hears = true;
  wire.watch(5.5, false);
  EXPECT_FALSE(wire.base.motors_on());
  EXPECT_TRUE(wire.run_until([&] { return wire.driver.ready() && !wire.driver.motors_on(); }, 10.0));
}

/// Every word wakes its watchdog, and it goes on as it was told last: it is left standing.
TEST(PioneerLeftAlone, ThatHearsAndObeysNothingIsRousedOnceAndNeverAgain) {
  LeftAlone wire;
  wire.deaf_to = [&wire](const std::string& packet) {
    if (!packet.empty()) wire.base.receive(arcos::command(arcos::kPulse), wire.now);
    return true;
  };
  wire.watch(14.0, false);
  for (int i = 0; i < 40000; ++i) {
    wire.step();
    ASSERT_EQ(wire.base.motion().v, 0.0) << "it drives after " << 14.0 + 1e-3 * i << " s";
  }
  EXPECT_TRUE(wire.base.motors_on());
  // Somebody drives it on: then there is nothing to lose.
  EXPECT_FALSE(wire.watch(11.0, true).empty());
}

TEST(PioneerLeftAlone, IsLeftForAsLongAsItSaysThatItsWatchdogWaits) {
  for (const int watchdog_ms : {1000, 6000}) {
    SCOPED_TRACE(watchdog_ms);
    ArcosEmulatorSettings emulator;
    emulator.configuration.watchdog_ms = watchdog_ms;
    LeftAlone wire(emulator);
    wire.watch(3.0, true);
    const std::vector<double> when = wire.watch(40.0, true);
    ASSERT_GE(when.size(), 9u);
    for (std::size_t i = 3; i < when.size(); ++i) EXPECT_NEAR(when[i] - when[i - 3], 1e-3 * watchdog_ms + 3.0, 0.2);
  }
}

}  // namespace
}  // namespace rubble::robot
