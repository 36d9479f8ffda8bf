#include "robot/drivers/rate_dither.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace rubble::robot {
namespace {

struct Held {
  double from;
  double to;
  int rate;
};

double mean(const std::vector<Held>& held, double from, double to) {
  double sum = 0.0;
  for (const Held& h : held) sum += h.rate * std::max(0.0, std::min(to, h.to) - std::max(from, h.from));
  return sum / (to - from);
}

TEST(RateDither, TheMeanOverAnySecondIsTheWantedRate) {
  constexpr unsigned kSeed = 11;
  std::mt19937 random(kSeed);
  for (const double wanted : {0.1, 0.37, -0.5, 1.95, 4.04, -7.77, 33.3}) {
    RateDither dither;
    std::vector<Held> held;
    Stamp now{1'700'000'000'000'000'000};
    const Stamp start = now;
    // Asked every 50 ms, some milliseconds late at times, as a timer does.
    while (now - start < 20.0) {
      const int rate = dither.next(wanted, now);
      const double wait = RateDither::kPeriod + (random() % 10 == 0 ? 0.004 : 0.0);
      held.push_back({now - start, now - start + wait, rate});
      now = now + wait;
    }
    for (double from = 0.5; from < 18.0; from += 0.013)
      EXPECT_NEAR(mean(held, from, from + 1.0), wanted, 0.1) << "from " << from << " s, seed " << kSeed;
  }
}

TEST(RateDither, WholeRatesAreSentAsTheyAre) {
  RateDither dither;
  for (int i = 0; i < 100; ++i) EXPECT_EQ(dither.next(12.0, {i * 20'000'000}), 12);
  EXPECT_FALSE(dither.restless());
}

TEST(RateDither, ZeroIsZeroAtOnce) {
  RateDither dither;
  dither.next(0.6, {0});
  dither.next(0.6, {40'000'000});
  EXPECT_EQ(dither.next(0.0, {80'000'000}), 0);
  EXPECT_EQ(dither.next(0.0, {90'000'000}), 0);
  EXPECT_FALSE(dither.restless());
}

TEST(RateDither, ALongPauseIsNotMadeUpFor) {
  RateDither dither;
  dither.next(0.4, {0});
  EXPECT_LE(dither.next(0.4, Stamp::from_seconds(100.0)), 2);
}

}  // namespace
}  // namespace rubble::robot
