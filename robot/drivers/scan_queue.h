#pragma once

#include <sys/eventfd.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <mutex>
#include <utility>
#include <vector>

#include "robot/drivers/descriptor.h"
#include "robot/drivers/scanner.h"

namespace rubble::robot {

/// What a scanner's thread hands over: scans, status and info, and a descriptor that is readable while scans wait.
class ScanQueue {
 public:
  ScanQueue() : ready_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}

  void put(LaserScan scan, Stamp arrived) {
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.last_scan = arrived;
    latencies_.emplace_back(arrived, status_.latency);
    while (arrived - latencies_.front().first > kRecent) latencies_.pop_front();
    status_.recent_latency = 0.0;
    for (const auto& [when, latency] : latencies_) status_.recent_latency = std::max(status_.recent_latency, latency);
    // A reader that sleeps for minutes shall not fill the memory: the newest scans are worth most.
    if (scans_.size() >= kMostScans) scans_.erase(scans_.begin());
    scans_.push_back(std::move(scan));
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(ready_.get(), &one, sizeof one);
  }

  std::vector<LaserScan> take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t got = ::read(ready_.get(), &count, sizeof count);
    return std::exchange(scans_, {});
  }

  /// Changes the status under the lock: `change(ScannerStatus&)`.
  template <typename Change>
  void update(const Change& change) {
    const std::lock_guard<std::mutex> lock(mutex_);
    change(status_);
  }
  void set_info(ScannerInfo info) {
    const std::lock_guard<std::mutex> lock(mutex_);
    info_ = std::move(info);
  }

  ScannerStatus status() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return status_;
  }
  ScannerInfo info() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return info_;
  }
  int descriptor() const { return ready_.get(); }

 private:
  static constexpr std::size_t kMostScans = 600;  // a minute of them
  static constexpr double kRecent = 3.0;          // [s]

  mutable std::mutex mutex_;
  Descriptor ready_;
  std::vector<LaserScan> scans_;
  std::deque<std::pair<Stamp, double>> latencies_;  ///< of late
  ScannerStatus status_;
  ScannerInfo info_;
};

}  // namespace rubble::robot
