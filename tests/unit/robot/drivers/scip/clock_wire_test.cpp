// The stamps of an emulated scanner whose line jitters and whose clock drifts, over minutes of a time without a clock.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include "robot/drivers/scip/scan_maker.h"
#include "robot/drivers/scip/scip_receiver.h"
#include "robot/drivers/scip/scip_text.h"
#include "robot/emulators/scip/scip_device.h"

namespace rubble::robot::scip {
namespace {

struct ClockCase {
  double jitter;  ///< scans arrive late by up to so much [s]
  double drift;   ///< the device's clock runs slow [s/s]
};

class ClockWire : public testing::TestWithParam<ClockCase> {};

TEST_P(ClockWire, StampsAreRightAfterAMinute) {
  constexpr unsigned kSeed = 11;
  std::mt19937 random(kSeed);
  const auto upto = [&](double most) { return most * static_cast<double>(random()) / 4294967296.0; };
  Device device(identity_of(LaserModel{}));
  device.set_clock(0.0, kClockWrap - 90'000);  // wraps on the way
  const Geometry geometry = device.identity().geometry;
  const Stamp start{1'700'000'000'000'000'000};
  const auto device_time = [&](Stamp host) { return (host - start) / (1.0 + GetParam().drift); };
  const auto say = [&](const std::string& line, Stamp when) {
    return device.receive(reinterpret_cast<const std::uint8_t*>(line.data()), line.size(), device_time(when));
  };
  Receiver receiver;
  ScanMaker maker(geometry, true, {});
  Stamp now = start + 2.0;
  say("SCIP2.0\n", now);
  say("TM0\n", now);
  for (int i = 0; i < 12; ++i) {
    now = now + 0.01 + upto(0.001);
    const Stamp asked = now;
    now = now + 0.0002 + upto(0.0005);
    const auto answer = say("TM1\n", now);
    ASSERT_EQ(answer.size(), 1u);
    now = now + 0.0002 + upto(0.0005);
    receiver.push(reinterpret_cast<const std::uint8_t*>(answer[0].data()), answer[0].size(), now);
    const auto reply = receiver.next();
    ASSERT_TRUE(reply && reply->lines.size() == 3u);
    maker.map().anchor(maker.clock().read(*decode(*checked(reply->lines[2])), now).time, asked, now);
  }
  say("TM2\n", now);
  say("BM\n", now);
  say("MD0044072501000\n", now);
  receiver.clear();
  const std::vector<std::uint32_t> values(static_cast<std::size_t>(device.identity().last_of_all) + 1, 1000);
  std::vector<double> errors;
  double sum = 0.0;
  for (int turn = 0; turn < 1800; ++turn) {
    const Stamp step0 = start + (2.3 + 0.10001 * turn);
    const auto blocks = device.turn(device_time(step0), values);
    ASSERT_EQ(blocks.size(), 1u);
    const Stamp arrived = step0 + (device.identity().last_of_all * geometry.step_time() + upto(GetParam().jitter));
    receiver.push(reinterpret_cast<const std::uint8_t*>(blocks[0].data()), blocks[0].size(), arrived);
    const auto reply = receiver.next();
    ASSERT_TRUE(reply);
    const auto sweep = sweep_of(*reply, geometry.steps());
    ASSERT_TRUE(sweep);
    const auto made = maker.make(*sweep, reply->begun, reply->ended);
    ASSERT_TRUE(made);
    if (step0 - start < 62.0) continue;
    errors.push_back(made->scan.stamp - (step0 + geometry.first_step * geometry.step_time()));
    sum += errors.back();
  }
  const double mean = sum / static_cast<double>(errors.size());
  for (double& error : errors) error = std::abs(error);
  std::sort(errors.begin(), errors.end());
  const double worst = errors[static_cast<std::size_t>(0.99 * static_cast<double>(errors.size() - 1))];
  std::cout << "jitter " << 1e3 * GetParam().jitter << " ms, drift " << 1e6 * GetParam().drift << " ppm: mean "
            << 1e3 * mean << " ms, 99 % " << 1e3 * worst << " ms, drift found " << 1e6 * maker.map().drift()
            << " ppm (seed " << kSeed << ")\n";
  EXPECT_LE(std::abs(mean), 0.5e-3);
  EXPECT_LE(worst, 1.5e-3);
}

INSTANTIATE_TEST_SUITE_P(Lines, ClockWire,
                         testing::Values(ClockCase{0.0, 0.0}, ClockCase{0.005, 50e-6}, ClockCase{0.005, -50e-6},
                                         ClockCase{0.02, 150e-6}));

}  // namespace
}  // namespace rubble::robot::scip
