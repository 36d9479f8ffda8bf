#pragma once

// What a machine that is busy elsewhere does to a test in real time, measured beside it.

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "robot/drivers/host_clock.h"

namespace rubble::robot {

/// Sleeps for two milliseconds again and again and knows when it was woken late.
class Witness {
 public:
  Witness() : thread_([this] { run(); }) {}
  ~Witness() { end(); }
  void end() {
    ending_ = true;
    if (thread_.joinable()) thread_.join();
  }
  /// All of it up to now [s].
  double total() const { return total_; }
  /// The longest up to now [s].
  double worst() const { return worst_; }
  /// So much of that time it had overslept [s]. After end().
  double overslept(Stamp from, Stamp to) const {
    double sum = 0.0;
    for (const auto& [due, woke] : late_) sum += std::max(0.0, std::min(to, woke) - std::max(from, due));
    return sum;
  }
  /// Of all its turns [s]. After end().
  double lateness(double part) const {
    std::vector<double> all;
    for (const auto& [due, woke] : late_) all.push_back(woke - due);
    std::sort(all.begin(), all.end());
    return all.empty() ? 0.0 : all[static_cast<std::size_t>(part * static_cast<double>(all.size() - 1))];
  }

 private:
  void run() {
    while (!ending_) {
      const Stamp due = host_now() + 0.002;
      sleep_until(due);
      late_.emplace_back(due, host_now());
      worst_ = std::max(worst_.load(), late_.back().second - due);
      total_ = total_ + std::max(0.0, late_.back().second - due);
    }
  }

  std::atomic<bool> ending_{false};
  std::atomic<double> worst_{0.0}, total_{0.0};
  std::vector<std::pair<Stamp, Stamp>> late_;
  std::thread thread_;  // the last: it uses the others
};

/// How long the threads of another program were ready to run and did not get a core, by the kernel's own account
/// (/proc/PID/task/*/schedstat). Asked fifty times a second as long as that program runs.
class QueueWatch {
 public:
  explicit QueueWatch(int pid) : tasks_("/proc/" + std::to_string(pid) + "/task"), thread_([this] { run(); }) {}
  ~QueueWatch() { end(); }
  void end() {
    ending_ = true;
    if (thread_.joinable()) thread_.join();
  }
  /// The thread that had to wait most, between the looks around these times [s]. After end().
  double waited(Stamp from, Stamp to) const {
    std::map<std::string, double> before, after;
    for (const auto& [when, delays] : looks_) {
      if (when <= from) before = delays;
      after = delays;
      if (when >= to) break;
    }
    double most = 0.0;
    for (const auto& [thread, delay] : after) {
      const auto first = before.find(thread);
      most = std::max(most, delay - (first == before.end() ? 0.0 : first->second));
    }
    return most;
  }

 private:
  void run() {
    while (!ending_) {
      std::map<std::string, double> delays;
      std::error_code gone;
      for (auto it = std::filesystem::directory_iterator(tasks_, gone);
           !gone && it != std::filesystem::directory_iterator(); it.increment(gone)) {
        double ran = 0.0, waited = 0.0;  // [ns]
        if (std::ifstream(it->path() / "schedstat") >> ran >> waited) delays[it->path().filename()] = 1e-9 * waited;
      }
      looks_.emplace_back(host_now(), std::move(delays));
      sleep_until(host_now() + 0.02);
    }
  }

  std::string tasks_;
  std::atomic<bool> ending_{false};
  std::vector<std::pair<Stamp, std::map<std::string, double>>> looks_;
  std::thread thread_;  // the last: it uses the others
};

}  // namespace rubble::robot
