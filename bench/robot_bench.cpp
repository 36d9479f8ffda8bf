#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "base/rng.h"
#include "robot/logs/own/log_codec.h"
#include "robot/logs/own/log_frames.h"
#include "robot/logs/own/range_codec.h"

namespace rubble::robot {
namespace {

/// 682 beams into a room with 10 mm noise, whole millimetres, all in range.
LaserScan noisy_scan(Stamp stamp) {
  const LaserModel laser;
  Rng noise(1, "scan");
  LaserScan scan;
  scan.stamp = stamp;
  set_geometry(scan, laser);
  for (int i = 0; i < laser.beams; ++i) {
    const double bearing = scan.bearing(static_cast<std::size_t>(i));
    const double wall =
        (1.6 + 0.8 * std::cos(bearing)) / std::max(std::abs(std::cos(bearing)), std::abs(std::sin(bearing)));
    const double range = std::round((wall + noise.gaussian(0.01)) * 1000.0) * 0.001;
    scan.ranges.push_back(static_cast<float>(range));
  }
  return scan;
}

/// What a tick of 0.1 s brings: a scan, an odometry, five accelerations and aims.
Inputs full_tick(Stamp now) {
  Inputs inputs;
  inputs.now = now;
  inputs.scans.push_back(noisy_scan(now - 0.1));
  Odometry odometry;
  odometry.stamp = now;
  odometry.pose = {1.0, 2.0, 0.5};
  inputs.odometry.push_back(odometry);
  for (int i = 0; i < 5; ++i) {
    inputs.accelerations.push_back({now - 0.02 * i, 0.1, -0.2});
    inputs.aims.push_back({now - 0.02 * i, 0.01, 0.02});
  }
  return inputs;
}

void EncodeScan(benchmark::State& state) {
  const LaserScan scan = noisy_scan(Stamp{0});
  std::string out;
  for (auto _ : state) {
    out.clear();
    encode_ranges(scan.ranges, out);
    benchmark::DoNotOptimize(out.data());
  }
  state.counters["bytes_per_beam"] = static_cast<double>(out.size()) / static_cast<double>(scan.ranges.size());
}
BENCHMARK(EncodeScan)->Unit(benchmark::kMicrosecond);

void EncodeTick(benchmark::State& state) {
  Inputs inputs = full_tick(Stamp::from_seconds(1.0));
  TickContext context;
  std::string out;
  for (auto _ : state) {
    out.clear();
    append_tick_frame(out, inputs, context);
    benchmark::DoNotOptimize(out.data());
  }
  state.counters["bytes"] = static_cast<double>(out.size());
}
BENCHMARK(EncodeTick)->Unit(benchmark::kMicrosecond);

/// Splits, checks and decodes a log of 60 s at 10 scans a second.
void DecodeLog(benchmark::State& state) {
  std::string log(kLogMagic);
  append_header_frame(log, {});
  TickContext writing;
  constexpr int kTicks = 600;
  for (int i = 1; i <= kTicks; ++i) append_tick_frame(log, full_tick(Stamp::from_seconds(0.1 * i)), writing);
  for (auto _ : state) {
    const Frames frames = split_frames(log, "bench.log");
    TickContext reading;
    for (std::size_t i = 1; i < frames.payloads.size(); ++i)
      benchmark::DoNotOptimize(decode_tick(frames.payloads[i], reading).scans.data());
  }
  state.counters["ticks_per_s"] = benchmark::Counter(
      static_cast<double>(kTicks) * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(DecodeLog)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rubble::robot
