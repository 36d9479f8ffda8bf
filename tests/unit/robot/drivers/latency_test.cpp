// From the last byte of a scan to the command that answers it, as the emulated devices see both. Of our own driver 99 %
// are within 30 ms on a machine that is fit to tell: witnesses beside it sleep and wake all the time, and 99 % of their
// turns are late by less than 2 ms. On another one the test is skipped and says so, but for the median.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "robot/drivers/host_clock.h"
#include "robot/drivers/mrpt_scanner.h"
#include "robot/drivers/real_robot.h"
#include "robot/drivers/scip/scip_scanner.h"
#include "robot/emulators/arcos_emulator.h"
#include "robot/emulators/device_server.h"
#include "robot/emulators/scip/urg_emulator.h"
#include "robot/protocols/arcos_commands.h"
#include "robot/protocols/arcos_packet.h"
#include "tests/support/machine_witness.h"
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
  std::vector<std::pair<Stamp, Stamp>> answers() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<std::pair<Stamp, Stamp>> all;
    for (const auto& [number, when] : answered_)
      if (const auto it = sent_.find(number); it != sent_.end()) all.emplace_back(it->second, when);
    return all;
  }

 private:
  mutable std::mutex mutex_;
  std::map<int, Stamp> sent_, answered_;
};

/// Sorted [s].
struct Delays {
  std::vector<double> as_seen;
  std::vector<double> own;  ///< less what the machine was late by
  double witness_99 = 0.0;  ///< 99 % of the witnesses' turns were late by less
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
Delays answer_scans(const std::string& word, const std::string& base_word, bool by_mrpt, double seconds) {
  Times times;
  std::atomic<int> leaving{-1};
  UrgEmulatorConfig config;
  config.port = word;
  config.scan_sent = [&](Stamp when) { times.sent(leaving, when); };
  UrgEmulator urg(config);
  ListeningBase arcos(times);
  DeviceServer base(base_word, arcos, 1);
  std::array<Witness, 2> witnesses;
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
  Delays delays;
  for (Witness& witness : witnesses) {
    witness.end();
    delays.witness_99 = std::max(delays.witness_99, witness.lateness(0.99));
  }
  for (const auto& [sent, answered] : times.answers()) {
    delays.as_seen.push_back(answered - sent);
    const double late = std::max(witnesses[0].overslept(sent, answered), witnesses[1].overslept(sent, answered));
    delays.own.push_back(answered - sent - late);
  }
  std::sort(delays.as_seen.begin(), delays.as_seen.end());
  std::sort(delays.own.begin(), delays.own.end());
  return delays;
}

class Latency : public testing::TestWithParam<std::string> {};

TEST_P(Latency, EveryScanIsAnsweredByItsOwnCommand) {
  const std::string kind = GetParam();
  std::string folder = (fs::temp_directory_path() / "latencyXXXXXX").string();
  ASSERT_NE(::mkdtemp(folder.data()), nullptr);
  const bool pty = kind.find("pty") != std::string::npos;
  const std::string urg = pty ? "pty:" + folder + "/urg" : "tcp:127.0.0.1:0";
  const std::string base = pty ? "pty:" + folder + "/base" : "tcp:127.0.0.1:0";
  const bool by_mrpt = kind.find("mrpt") != std::string::npos;
  Delays delays = answer_scans(urg, base, by_mrpt, by_mrpt ? 7.0 : 12.0);
  for (int again = 0; again < 2 && !by_mrpt && delays.witness_99 >= 0.002; ++again)
    delays = answer_scans(urg, base, by_mrpt, 12.0);  // the machine stalled; perhaps it has done with that
  fs::remove_all(folder);
  ASSERT_GT(delays.own.size(), 30u);
  const auto share = [](const std::vector<double>& all, double part) {
    return 1e3 * all[static_cast<std::size_t>(part * static_cast<double>(all.size() - 1))];
  };
  const bool fit = delays.witness_99 < 0.002;  // else the machine is what is measured
  if (!by_mrpt && fit) {
    EXPECT_LT(share(delays.as_seen, 0.99), 30.0) << "load of the machine " << load();
  }
  std::cout << kind << ": " << delays.own.size() << " scans, last byte to command: median "
            << share(delays.as_seen, 0.5) << " ms, 99 % " << share(delays.as_seen, 0.99) << " ms, worst "
            << share(delays.as_seen, 1.0) << " ms; less what the machine was late by: 99 % " << share(delays.own, 0.99)
            << " ms, worst " << share(delays.own, 1.0) << " ms (load " << load() << ", a sleeper beside it late by "
            << 1e3 * delays.witness_99 << " ms, 99 %)\n";
  if (!by_mrpt && !fit) {
    EXPECT_LT(share(delays.as_seen, 0.5), 30.0) << "load of the machine " << load();
    GTEST_SKIP() << "this machine wakes a sleeper 2 ms late or more: not held to 99 % within 30 ms";
  }
}

INSTANTIATE_TEST_SUITE_P(All, Latency, testing::Values("own_tcp", "own_pty", "mrpt_tcp", "mrpt_pty"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace rubble::robot
