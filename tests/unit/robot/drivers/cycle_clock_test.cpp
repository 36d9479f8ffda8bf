#include "robot/drivers/cycle_clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rubble::robot {
namespace {

TEST(CycleClock, HeldUpReportsKeepTheirPlaceInTheCycle) {
  constexpr unsigned kSeed = 5;
  std::mt19937 random(kSeed);
  std::exponential_distribution<double> delay(1.0 / 0.003);
  CycleClock clock;
  clock.set_cycle(0.1);
  double worst = 0.0;
  for (int i = 0; i < 600; ++i) {
    if (random() % 20 == 0) continue;  // lost
    const double sent = 100.0 + 0.1 * (1.0 + 50e-6) * i;
    const double late = std::min(0.06, delay(random));
    const double error = clock.stamp(Stamp::from_seconds(sent + late)).seconds() - sent;
    if (i > 50) worst = std::max(worst, std::abs(error));
  }
  EXPECT_LT(worst, 0.003) << "seed " << kSeed;
}

TEST(CycleClock, ADeviceThatShiftsIsFollowed) {
  CycleClock clock;
  clock.set_cycle(0.1);
  double error = 1.0;
  for (int i = 0; i < 100; ++i) {
    const double sent = 0.1 * i + (i > 30 ? 0.05 : 0.0);
    error = clock.stamp(Stamp::from_seconds(sent)).seconds() - sent;
  }
  EXPECT_NEAR(error, 0.0, 1e-6);
}

TEST(CycleClock, StampsAlwaysGrow) {
  CycleClock clock;
  clock.set_cycle(0.1);
  Stamp last = clock.stamp({1000});
  for (int i = 0; i < 10; ++i) {
    const Stamp stamp = clock.stamp({1000});
    EXPECT_GT(stamp, last);
    last = stamp;
  }
}

TEST(CycleClock, ReportsHeldUpTogetherLeftACycleApart) {
  for (const std::size_t held : {2u, 5u, 60u}) {
    CycleClock clock;
    clock.set_cycle(0.1);
    for (int i = 0; i < 10; ++i) clock.stamp(Stamp::from_seconds(0.1 * i));
    const double arrived = 0.1 * static_cast<double>(9 + held);
    for (std::size_t k = 0; k < held; ++k) {
      const double sent = 0.1 * static_cast<double>(10 + k);
      EXPECT_NEAR(clock.stamp(Stamp::from_seconds(arrived), held - 1 - k).seconds(), sent, 1e-6) << held << ", " << k;
    }
  }
}

TEST(CycleClock, MoreReportsThanThereWasTimeForShareIt) {
  CycleClock clock;
  clock.set_cycle(0.1);
  Stamp last = clock.stamp(Stamp::from_seconds(1.0));
  for (std::size_t k = 0; k < 4; ++k) {
    const Stamp stamp = clock.stamp(Stamp::from_seconds(1.2), 3 - k);
    EXPECT_NEAR(stamp - last, 0.05, 1e-6);
    last = stamp;
  }
  EXPECT_NEAR(last.seconds(), 1.2, 1e-6);
}

TEST(CycleClock, WithoutACycleArrivalsCount) {
  CycleClock clock;
  EXPECT_EQ(clock.stamp({5}), Stamp{5});
  EXPECT_EQ(clock.stamp({500'000'000}), Stamp{500'000'000});
}

}  // namespace
}  // namespace rubble::robot
