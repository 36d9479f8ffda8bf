// Device clocks against the computer's: drift, jitter, wraps and restarts.
#include "robot/drivers/clock_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "base/rng.h"

namespace rubble::robot {
namespace {

constexpr double kPeriod = 0.1;
constexpr double kLeastDelay = 0.075;
const Stamp kStart = Stamp::from_seconds(1.7e9);

/// A device whose clock reads `device` whole milliseconds at host time `host`, and messages about it.
struct TickingDevice {
  double drift;   ///< it runs slow by so much [s/s]
  double offset;  ///< host time since kStart of its zero [s]
  Rng rng;

  Stamp host_of(double device_exact) const { return kStart + (offset + device_exact * (1.0 + drift)); }
  static double cut(double device_exact) { return std::floor(device_exact * 1000.0) / 1000.0; }
};

enum class Jitter { Uniform, Exponential };

double draw(Rng& rng, Jitter kind) {
  return kind == Jitter::Uniform ? rng.uniform(0.0, 0.005) : -0.005 * std::log(1.0 - rng.uniform());
}

struct Errors {
  double mean;
  double worst99;
};

/// The simulator's motor turns ten times a second of the computer's clock; a real one wanders.
enum class Motor { Exact, Wanders };

double turn_time(TickingDevice& device, Motor motor) {
  if (motor == Motor::Exact) return kPeriod / (1.0 + device.drift);
  return kPeriod + device.rng.gaussian(50e-6);
}

Errors errors_after_a_minute(double drift, Jitter jitter, Motor motor, std::uint64_t seed, bool anchored) {
  TickingDevice device{drift, 12.3456, Rng{seed, "device"}};
  ClockMapConfig config;
  config.usual_delay = kLeastDelay;
  ClockMap map(config);
  double exact = 3.0 + device.rng.uniform();
  if (anchored)
    for (int i = 0; i < 12; ++i) {
      exact += device.rng.uniform(0.0005, 0.0015);
      const Stamp at = device.host_of(exact);
      map.anchor(TickingDevice::cut(exact), at - device.rng.uniform(0.00005, 0.0002),
                 at + device.rng.uniform(0.00005, 0.0002));
    }
  std::vector<double> errors;
  for (int turn = 0; turn < 2400; ++turn) {
    exact += turn_time(device, motor);
    const double stamp = TickingDevice::cut(exact);
    map.add(stamp, device.host_of(exact) + (kLeastDelay + draw(device.rng, jitter)));
    if (turn >= 600) errors.push_back(map.host(stamp) - device.host_of(exact));
  }
  Errors result{0.0, 0.0};
  for (const double e : errors) result.mean += e / static_cast<double>(errors.size());
  std::vector<double> sizes;
  for (const double e : errors) sizes.push_back(std::abs(e));
  std::sort(sizes.begin(), sizes.end());
  result.worst99 = sizes[sizes.size() * 99 / 100];
  return result;
}

TEST(ClockMap, StampsAreRightAfterAMinuteOfJitterAndDrift) {
  double worst_mean = 0.0, worst = 0.0;
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u})
    for (const double drift : {-50e-6, 0.0, 50e-6})
      for (const Jitter jitter : {Jitter::Uniform, Jitter::Exponential})
        for (const Motor motor : {Motor::Exact, Motor::Wanders})
          for (const bool anchored : {false, true}) {
            // A part of a millisecond that never changes cannot be told from the delay: nothing is known better than
            // half a millisecond then.
            if (drift == 0.0 && motor == Motor::Exact) continue;
            const Errors e = errors_after_a_minute(drift, jitter, motor, seed, anchored);
            worst_mean = std::max(worst_mean, std::abs(e.mean));
            worst = std::max(worst, e.worst99);
            EXPECT_LT(std::abs(e.mean), 0.0005) << "seed " << seed << " drift " << drift << " anchored " << anchored;
            EXPECT_LT(e.worst99, 0.0015) << "seed " << seed << " drift " << drift << " anchored " << anchored;
          }
  std::cout << "worst of all: mean " << worst_mean * 1e3 << " ms, 99 % below " << worst * 1e3 << " ms\n";
}

TEST(ClockMap, DriftIsFound) {
  for (const double drift : {-80e-6, 0.0, 120e-6}) {
    TickingDevice device{drift, 0.0, Rng{7, "device"}};
    ClockMap map({});
    for (int turn = 1; turn < 900; ++turn)
      map.add(turn * kPeriod, device.host_of(turn * kPeriod) + device.rng.uniform(0.0, 0.005));
    EXPECT_NEAR(map.drift(), drift, 5e-6);
  }
}

TEST(ClockMap, WithoutJitterItIsExactFromTheFirstMessage) {
  TickingDevice device{0.0, 5.0, Rng{1, "device"}};
  ClockMapConfig config;
  config.resolution = 0.0;
  config.usual_delay = 0.02;
  ClockMap map(config);
  for (int turn = 0; turn < 20; ++turn) {
    const double time = 1.0 + turn * kPeriod;
    map.add(time, device.host_of(time) + 0.02);
    EXPECT_NEAR(map.host(time) - device.host_of(time), 0.0, 1e-6);
  }
}

TEST(ClockMap, AnchorTellsTheLeastDelay) {
  TickingDevice device{0.0, 5.0, Rng{3, "device"}};
  ClockMap map({});
  double exact = 1.0;
  for (int i = 0; i < 12; ++i) {
    exact += 0.00127;
    map.anchor(TickingDevice::cut(exact), device.host_of(exact) - 1e-4, device.host_of(exact) + 1e-4);
  }
  ASSERT_TRUE(map.doubt().has_value());
  EXPECT_LT(*map.doubt(), 0.0004);
  // The stamp is of a moment 43 ms before the message leaves: what usual_delay would have had to be told.
  for (int turn = 0; turn < 200; ++turn) {
    exact += kPeriod * (1.0 + 1e-4);
    map.add(TickingDevice::cut(exact), device.host_of(exact) + (0.043 + device.rng.uniform(0.0, 0.001)));
  }
  EXPECT_NEAR(map.least_delay(), 0.043, 0.0005);
}

TEST(ClockMap, WildArrivalsMoveNothing) {
  TickingDevice device{30e-6, 0.0, Rng{5, "device"}};
  ClockMapConfig config;
  config.resolution = 0.0;
  ClockMap map(config);
  for (int turn = 1; turn < 300; ++turn) {
    const double late = turn % 3 == 0 ? 0.0 : device.rng.uniform(0.0, 0.8);  // a USB hub that sleeps
    map.add(turn * kPeriod, device.host_of(turn * kPeriod) + late);
  }
  EXPECT_NEAR(map.host(29.0) - device.host_of(29.0), 0.0, 1e-4);
}

TEST(WrappingClock, CountsOnOverTheWrap) {
  const std::uint32_t wrap = 1u << 24;
  WrappingClock clock(wrap, 1e-3);
  double expected = (wrap - 250) * 1e-3;
  for (int i = 0; i < 10; ++i) {
    const auto count = static_cast<std::uint32_t>((wrap - 250 + 100 * static_cast<std::uint32_t>(i)) % wrap);
    const auto reading = clock.read(count, kStart + 0.1 * i);
    EXPECT_FALSE(reading.restarted);
    EXPECT_NEAR(reading.time, expected + 0.1 * i, 1e-9);
  }
}

TEST(WrappingClock, ALongSilenceMayHoldSeveralWraps) {
  const std::uint32_t wrap = 1u << 16;  // 65.5 s, as of a counter of 16 bits in milliseconds
  WrappingClock clock(wrap, 1e-3);
  clock.read(1000, kStart);
  const auto reading = clock.read((1000 + 200000) % wrap, kStart + 200.0);
  EXPECT_FALSE(reading.restarted);
  EXPECT_NEAR(reading.time, 201.0, 1e-9);
}

TEST(WrappingClock, ARestartIsSeen) {
  WrappingClock clock(1u << 24, 1e-3);
  clock.read(500000, kStart);
  clock.read(500100, kStart + 0.1);
  const auto reading = clock.read(40, kStart + 0.2);
  EXPECT_TRUE(reading.restarted);
  EXPECT_NEAR(reading.time, 0.04, 1e-9);
  EXPECT_FALSE(clock.read(140, kStart + 0.3).restarted);
}

}  // namespace
}  // namespace rubble::robot
