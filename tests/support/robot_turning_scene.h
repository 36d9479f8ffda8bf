#pragma once

// A scanner's world for tests of drivers and emulators: a new scan every turn, in real time.

#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>
#include <thread>
#include <vector>

#include "robot/drivers/host_clock.h"
#include "robot/measurements.h"
#include "robot/model.h"

namespace rubble::robot {

/// Ranges that differ from beam to beam, whole millimetres as a scanner gives; beam 0 holds the number of the turn, and
/// some beams have no echo (miss) or could not be measured.
inline LaserScan numbered_scan(const LaserModel& laser, int number, Stamp step0) {
  LaserScan scan;
  set_geometry(scan, laser);
  scan.stamp = step0 + 44 * laser.beam_period;
  for (int i = 0; i < laser.beams; ++i) scan.ranges.push_back(static_cast<float>((500 + 3 * i + number % 7) * 0.001));
  scan.ranges[0] = static_cast<float>((1000 + number) * 0.001);
  scan.ranges[100] = std::numeric_limits<float>::infinity();
  scan.ranges[200] = std::numeric_limits<float>::quiet_NaN();
  scan.codes.assign(scan.ranges.size(), 0);
  scan.codes[200] = 7;  // neighbours in error
  return scan;
}

inline int number_of(const LaserScan& scan) { return static_cast<int>(std::lround(scan.ranges[0] * 1000.0f)) - 1000; }

/// Publishes a numbered scan every turn, 76 ms after its begin, until it is destroyed; remembers the true stamps.
class TurningScene {
 public:
  using Publish = std::function<void(const LaserScan&)>;

  TurningScene(const LaserModel& laser, Publish publish)
      : laser_(laser), publish_(std::move(publish)), thread_([this] { run(); }) {}
  ~TurningScene() {
    ending_ = true;
    thread_.join();
  }

  /// The true stamp of beam 0 in the scan of that number.
  Stamp stamp(int number) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return stamps_.at(static_cast<std::size_t>(number));
  }
  int published() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return static_cast<int>(stamps_.size());
  }

 private:
  void run() {
    const Stamp start = host_now();
    for (int number = 0; !ending_; ++number) {
      const Stamp step0 = start + number * laser_.scan_period;
      sleep_until(step0 + 0.76 * laser_.scan_period);
      const LaserScan scan = numbered_scan(laser_, number, step0);
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        stamps_.push_back(scan.stamp);
      }
      publish_(scan);
    }
  }

  LaserModel laser_;
  Publish publish_;
  mutable std::mutex mutex_;
  std::vector<Stamp> stamps_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace rubble::robot
