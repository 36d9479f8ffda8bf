// A real client of others: Debian's rawlog-grabber (mrpt-apps) records the emulated scanner, and we read its log.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <thread>
#include <vector>

#include "base/error.h"
#include "robot/drivers/descriptor.h"
#include "robot/drivers/host_clock.h"
#include "robot/emulators/scip/urg_emulator.h"
#include "robot/logs/log.h"
#include "tests/support/machine_witness.h"
#include "tests/support/robot_turning_scene.h"

namespace rubble::robot {
namespace {

namespace fs = std::filesystem;

/// The client reads for 0.1 s at a time, which is as long as a turn takes: held up by more than what is between two of
/// its reads it cuts an answer in two and loses it [s].
constexpr double kBetweenReads = 0.004;
constexpr double kAnswerTime = 0.1;  ///< of the client, also in its handshake [s]
constexpr double kHandshake = 3.0;   ///< longer than that takes [s]

/// rawlog-grabber in `folder`, which has a grab.ini; it ends as soon as its input does.
class Grabber {
 public:
  explicit Grabber(const fs::path& folder) {
    std::array<int, 2> input{};
    if (::pipe2(input.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    const Descriptor theirs(input[0]);
    input_ = Descriptor(input[1]);
    const std::string ini = (folder / "grab.ini").string(), said = (folder / "grab.txt").string();
    pid_ = ::fork();
    if (pid_ == 0) {
      const int out = ::open(said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      ::dup2(input[0], 0);
      ::dup2(out, 1);
      ::dup2(out, 2);
      ::execlp("rawlog-grabber", "rawlog-grabber", ini.c_str(), nullptr);
      ::_exit(127);
    }
  }
  ~Grabber() {
    if (pid_ > 0) end();
  }
  int pid() const { return pid_; }
  /// Its exit code; -1: it had to be killed.
  int end() {
    [[maybe_unused]] const ssize_t written = ::write(input_.get(), "\n", 1);
    input_.close();
    int status = 0;
    const Stamp late = host_now() + 60.0;
    while (::waitpid(pid_, &status, WNOHANG) == 0) {
      if (host_now() > late) ::kill(pid_, SIGKILL);
      sleep_until(host_now() + 0.02);
    }
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  Descriptor input_;
  pid_t pid_ = -1;
};

std::vector<LaserScan> recorded_in(const fs::path& folder) {
  std::vector<LaserScan> scans;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".rawlog") continue;
    try {
      ReplayRobot log(entry.path().string());
      while (const auto inputs = log.read()) scans.insert(scans.end(), inputs->scans.begin(), inputs->scans.end());
    } catch (const InputError&) {
      // Nothing was recorded: the handshake came to nothing.
    }
    fs::remove(entry.path());
  }
  return scans;
}

/// What one run of the client recorded, and how the machine was meanwhile.
struct Record {
  std::vector<LaserScan> scans;
  std::vector<int> missing;     ///< turns between the first and the last
  std::vector<double> held_up;  ///< around each of these: the most that the client, we or a sleeper were late by [s]
  double worst = 0.0;           ///< of all the time [s]
  double at_once = 0.0;         ///< the most within an answer's time of the handshake [s]
};

Record record(const fs::path& folder, double duration, const TurningScene& scene) {
  Record record;
  Witness sleeper;
  QueueWatch ours(::getpid());
  const Stamp begun = host_now();
  Grabber grabber(folder);
  QueueWatch theirs(grabber.pid());
  sleep_until(host_now() + duration);
  EXPECT_EQ(grabber.end(), 0);
  sleeper.end();
  ours.end();
  theirs.end();
  const auto held_up = [&](Stamp from, Stamp to) {
    return std::max({sleeper.overslept(from, to), ours.waited(from, to), theirs.waited(from, to)});
  };
  record.worst = held_up(begun, host_now());
  for (Stamp from = begun; from < begun + kHandshake; from = from + 0.5 * kAnswerTime)
    record.at_once = std::max(record.at_once, held_up(from, from + kAnswerTime));
  record.scans = recorded_in(folder);
  for (std::size_t i = 1; i < record.scans.size(); ++i) {
    for (int n = number_of(record.scans[i - 1]) + 1; n < number_of(record.scans[i]); ++n) {
      record.missing.push_back(n);
      record.held_up.push_back(held_up(scene.stamp(n) - 0.1, scene.stamp(n) + 0.3));
    }
  }
  return record;
}

class RawlogGrabber : public testing::TestWithParam<std::string> {};

/// Every turn that the emulator ends, but for those at which the machine was held up, as it was measured beside.
TEST_P(RawlogGrabber, RecordsTenScansASecond) {
  if (std::system("command -v rawlog-grabber >/dev/null") != 0) GTEST_SKIP() << "mrpt-apps is not installed";
  std::string name = (fs::temp_directory_path() / "grabXXXXXX").string();
  const fs::path folder = ::mkdtemp(name.data());
  UrgEmulatorConfig config;
  config.port = GetParam() == "tcp" ? "tcp:127.0.0.1:0" : "pty:" + (folder / "urg").string();
  UrgEmulator emulator(config);
  const TurningScene scene(config.laser, [&](const LaserScan& scan) { emulator.publish(scan); });
  const std::string port = emulator.port();
  std::ofstream(folder / "grab.ini")
      << "[global]\nrawlog_prefix = " << (folder / "grabbed").string()
      << "\ntime_between_launches = 100\nuse_sensoryframes = 0\nGRABBER_PERIOD_MS = 100\n"
      << "[LASER]\ndriver = CHokuyoURG\nprocess_rate = 200\nsensorLabel = LASER\n"
      << "pose_x = 0\npose_y = 0\npose_z = 0\npose_yaw = 0\npose_pitch = 0\npose_roll = 0\n"
      << (GetParam() == "tcp" ? "IP_DIR = 127.0.0.1\nPORT_DIR = " + port.substr(port.rfind(':') + 1)
                              : "COM_port_LIN = " + (folder / "urg").string())
      << "\n";
  // It gives every answer 0.1 s and the handshake one try: a machine that is busy elsewhere gets more time, and again.
  // The handshake takes 0.2 s over TCP and about a second over a serial line.
  Record kept;
  double least_at_once = 1e9;  // of the tries
  double duration = GetParam() == "tcp" ? 2.0 : 3.5;
  for (int tries = 0; tries < 5 && (kept.scans.size() < 8 || !kept.missing.empty()); ++tries) {
    Record fresh = record(folder, duration, scene);
    for (std::size_t i = 0; i < fresh.missing.size(); ++i)
      EXPECT_GT(fresh.held_up[i], kBetweenReads)
          << "turn " << fresh.missing[i] << " is missing, and nothing held it up";
    std::cout << GetParam() << ": " << fresh.scans.size() << " scans, " << fresh.missing.size()
              << " turns missing; the machine held somebody up by " << 1e3 * fresh.worst << " ms in all\n";
    least_at_once = std::min(least_at_once, fresh.at_once);
    if (fresh.scans.size() < 8) duration = std::min(16.0, 2.0 * duration);
    if (kept.scans.size() < 8 || (fresh.scans.size() >= 8 && fresh.missing.size() < kept.missing.size()))
      kept = std::move(fresh);
  }
  const std::vector<LaserScan>& scans = kept.scans;
  fs::remove_all(folder);
  if (scans.size() < 8 && least_at_once > 0.5 * kAnswerTime)
    GTEST_SKIP() << "at every try this machine held somebody up by " << 1e3 * least_at_once
                 << " ms or more at once, of the 100 ms that the client gives an answer of its handshake";
  ASSERT_GE(scans.size(), 8u);
  EXPECT_LT(kept.missing.size(), scans.size()) << "more is lost than kept, five times";
  for (std::size_t i = 1; i < scans.size(); ++i) EXPECT_GT(number_of(scans[i]), number_of(scans[i - 1]));
  const double turns = number_of(scans.back()) - number_of(scans.front());
  const double period = (scans.back().stamp - scans.front().stamp) / turns;
  EXPECT_NEAR(period, 0.1, 0.0005 + kept.worst / turns) << "the first ten are stamped on arrival";
  std::cout << GetParam() << ": " << 1.0 / period << " turns a second\n";
}

INSTANTIATE_TEST_SUITE_P(Both, RawlogGrabber, testing::Values("tcp", "pty"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace rubble::robot
