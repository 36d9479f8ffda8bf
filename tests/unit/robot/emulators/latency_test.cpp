// From the last byte of a scan to the command that answers it, as the emulated devices see both. Prints the times; they
// are the machine's. Asserted is only the median of our own driver, ten times above what is usual: a driver that waits
// for a timer instead of the arrival exceeds it.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <mutex>
#include <thread>

#include "robot/drivers/host_clock.h"
#include "robot/drivers/mrpt_scanner.h"
#include "robot/drivers/real_robot.h"
#include "robot/drivers/scip/scip_scanner.h"
#include "robot/emulators/arcos_emulator.h"
#include "robot/emulators/device_server.h"
#include "robot/emulators/scip/urg_emulator.h"
#include "robot/protocols/arcos_commands.h"
#include "robot/protocols/arcos_packet.h"
#include "tests/support/robot_turning_scene.h"

namespace rubble::robot {
namespace {

namespace fs = std::filesystem;

constexpr int kNumbers = 200;     ///< scans are told apart modulo this
constexpr int kFirstSpeed = 100;  ///< of the answer to scan 0 [mm/s]

/// When each scan left the scanner, and when the speed that names it reached the base.
class Times {
 public:
  void sent(int number, Stamp when) {
    const std::lock_guard<std::mutex> lock(mutex_);
    sent_[number] = when;
  }
  void answered(int number, Stamp when) {
    const std::lock_guard<std::mutex> lock(mutex_);
    answered_.emplace(number, when);
  }
  /// Sorted [s].
  std::vector<double> delays() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<double> all;
    for (const auto& [number, when] : answered_)
      if (const auto it = sent_.find(number); it != sent_.end()) all.push_back(when - it->second);
    std::sort(all.begin(), all.end());
    return all;
  }

 private:
  mutable std::mutex mutex_;
  std::map<int, Stamp> sent_, answered_;
};

/// A base that tells when a forward speed reaches it.
class ListeningBase : public ArcosEmulator {
 public:
  explicit ListeningBase(Times& times) : ArcosEmulator(ArcosEmulatorSettings{}), times_(times) {}
  void receive(std::string_view bytes, Stamp now) override {
    parser_.feed(bytes);
    while (const auto payload = parser_.next()) {
      const auto order = arcos::parse_order(*payload);
      if (!order || order->number != arcos::kVelocity || !order->value) continue;
      if (*order->value >= kFirstSpeed && *order->value < kFirstSpeed + kNumbers)
        times_.answered(*order->value - kFirstSpeed, now);
    }
    ArcosEmulator::receive(bytes, now);
  }

 private:
  Times& times_;
  arcos::PacketParser parser_;
};

std::string load() {
  std::ifstream in("/proc/loadavg");
  std::string first;
  in >> first;
  return first;
}

/// Answers every scan with a speed of its own for `seconds` (at most kNumbers scans); the delays.
std::vector<double> answer_scans(const std::string& word, const std::string& base_word, bool by_mrpt, double seconds) {
  Times times;
  std::atomic<int> leaving{-1};
  UrgEmulatorConfig config;
  config.port = word;
  config.scan_sent = [&](Stamp when) { times.sent(leaving, when); };
  UrgEmulator urg(config);
  ListeningBase arcos(times);
  DeviceServer base(base_word, arcos, 1);
  TurningScene scene(LaserModel{}, [&](const LaserScan& scan) {
    leaving = number_of(scan) % kNumbers;
    urg.publish(scan);
  });
  std::unique_ptr<Scanner> scanner;
  if (by_mrpt) {
    MrptScannerConfig mrpt;
    mrpt.port = urg.port();
    scanner = mrpt_scanner(mrpt);
  } else {
    ScipScannerConfig own;
    own.port = urg.port();
    scanner = std::make_unique<ScipScanner>(own);
  }
  RealRobotSettings settings;
  settings.base_port = base.port();
  settings.safety.start = 30.0;
  settings.model.has_levelling_unit = false;
  RealRobot robot(settings, *scanner, nullptr);
  std::atomic<bool> ending{false};
  std::thread reports([&] {
    const Stamp start = host_now();
    for (int i = 0; !ending; ++i) {
      sleep_until(start + 0.1 * i);
      base.with([&] { arcos.measure({host_now(), {}, 0.0, 0.0, false}, host_now()); });
    }
  });
  Stamp first = Stamp::never();
  double speed = 0.0;
  while (auto inputs = robot.read()) {
    if (first == Stamp::never()) first = inputs->now;
    if (inputs->now - first > seconds) break;
    if (!inputs->scans.empty()) speed = 1e-3 * (kFirstSpeed + number_of(inputs->scans.back()) % kNumbers);
    robot.command({{speed, 0.0}, {}});
  }
  ending = true;
  reports.join();
  return times.delays();
}

class Latency : public testing::TestWithParam<std::string> {};

TEST_P(Latency, EveryScanIsAnsweredByItsOwnCommand) {
  const std::string kind = GetParam();
  std::string folder = (fs::temp_directory_path() / "latencyXXXXXX").string();
  ASSERT_NE(::mkdtemp(folder.data()), nullptr);
  const bool pty = kind.find("pty") != std::string::npos;
  const std::string urg = pty ? "pty:" + folder + "/urg" : "tcp:127.0.0.1:0";
  const std::string base = pty ? "pty:" + folder + "/base" : "tcp:127.0.0.1:0";
  const std::vector<double> delays = answer_scans(urg, base, kind.find("mrpt") != std::string::npos, 7.0);
  fs::remove_all(folder);
  ASSERT_GT(delays.size(), 30u);
  const auto share = [&](double part) {
    return 1e3 * delays[static_cast<std::size_t>(part * static_cast<double>(delays.size() - 1))];
  };
  if (kind.find("own") == 0) {
    EXPECT_LT(share(0.5), 30.0) << "load of the machine " << load();
  }
  std::cout << kind << ": " << delays.size() << " scans, last byte to command: median " << share(0.5) << " ms, 99 % "
            << share(0.99) << " ms, worst " << share(1.0) << " ms (load of the machine " << load() << ")\n";
}

INSTANTIATE_TEST_SUITE_P(All, Latency, testing::Values("own_tcp", "own_pty", "mrpt_tcp", "mrpt_pty"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace rubble::robot
