// The levelling unit behind a line that is slow either way: it is not driven with before that is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <random>
#include <string>
#include <utility>

#include "robot/drivers/levelling_unit.h"
#include "robot/emulators/levelling_emulator.h"

namespace rubble::robot {
namespace {

constexpr double kPermittedSwing = 0.25;  ///< answers may be late by so much [s]

/// Driver and emulated unit at the ends of a line; whole messages of either may get lost.
class SlowUnit {
 public:
  SlowUnit(double way, double loss, unsigned seed) : way_(way), loss_(loss), random_(seed) {
    unit_.client_came(now);
    driver.opened(now, LineKind::Tcp);
  }

  void step() {
    now = now + 0.001;
    driver.advance(now);
    pass(driver.take_output(now), to_unit_);
    for (; !to_unit_.empty() && to_unit_.front().first <= now; to_unit_.pop_front())
      unit_.receive(to_unit_.front().second, now);
    unit_.advance(now);
    if (++steps_ % 20 == 0) unit_.measure({}, {now, 0.0, 0.0}, now);
    pass(unit_.take_output(), to_driver_);
    for (; !to_driver_.empty() && to_driver_.front().first <= now; to_driver_.pop_front())
      driver.receive(to_driver_.front().second, now);
  }
  bool could_drive() const { return driver.ready() && driver.answers(now).late <= kPermittedSwing; }

  Stamp now{1'700'000'000'000'000'000};
  LevellingUnit driver{LevellingUnitSettings{}};

 private:
  using Way = std::deque<std::pair<Stamp, std::string>>;
  void pass(const std::string& bytes, Way& way) {
    if (bytes.empty() || std::uniform_real_distribution<double>()(random_) < loss_) return;
    way.emplace_back(now + way_, bytes);
  }

  const double way_, loss_;
  std::mt19937 random_;
  LevellingEmulator unit_{LevellingEmulatorSettings{}};
  Way to_unit_, to_driver_;
  int steps_ = 0;
};

TEST(ALevellingUnitBehindASlowLine, IsNotDrivenWithForAMoment) {
  for (const double way : {0.15, 0.3, 0.45, 0.6, 1.0}) {
    for (const double loss : {0.0, 0.1, 0.3}) {
      for (unsigned seed = 1; seed <= (loss > 0.0 ? 15 : 1); ++seed) {
        SCOPED_TRACE(testing::Message() << way << " s each way, loss " << loss << ", seed " << seed);
        SlowUnit line(way, loss, seed);
        for (int i = 0; i < 12000; ++i) {
          line.step();
          ASSERT_FALSE(line.could_drive()) << "after " << 1e-3 * i << " s";
        }
        EXPECT_TRUE(line.driver.ready() || loss > 0.0);
      }
    }
  }
}

TEST(ALevellingUnitBehindAQuickLine, IsDrivenWithSoon) {
  for (const double way : {0.0, 0.01, 0.05}) {
    for (const double loss : {0.0, 0.1}) {
      for (unsigned seed = 1; seed <= (loss > 0.0 ? 20 : 1); ++seed) {
        SlowUnit line(way, loss, seed);
        int i = 0;
        while (i < 12000 && !line.could_drive()) {
          line.step();
          ++i;
        }
        EXPECT_LT(1e-3 * i, loss > 0.0 ? 5.0 : 0.5) << way << " s each way, loss " << loss << ", seed " << seed;
      }
    }
  }
}

}  // namespace
}  // namespace rubble::robot
