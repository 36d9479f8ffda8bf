// A real client of others: Debian's rawlog-grabber (mrpt-apps) records the emulated scanner, and we read its log.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <vector>

#include "base/error.h"
#include "robot/emulators/scip/urg_emulator.h"
#include "robot/logs/log.h"
#include "tests/support/robot_turning_scene.h"

namespace rubble::robot {
namespace {

namespace fs = std::filesystem;

/// Runs rawlog-grabber for so long [s]; it ends as soon as its input does. Returns the scans that it recorded.
std::vector<LaserScan> grab(const fs::path& folder, double duration) {
  const std::string command = "cd " + folder.string() + " && rm -f *.rawlog && (sleep " + std::to_string(duration) +
                              "; echo) | timeout 60 rawlog-grabber grab.ini >grab.txt 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::vector<LaserScan> scans;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".rawlog") continue;
    try {
      ReplayRobot log(entry.path().string());
      while (const auto inputs = log.read()) scans.insert(scans.end(), inputs->scans.begin(), inputs->scans.end());
    } catch (const InputError&) {
      // Nothing was recorded: the handshake came to nothing.
    }
  }
  return scans;
}

class RawlogGrabber : public testing::TestWithParam<std::string> {};

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
  std::vector<LaserScan> scans;
  // It gives every answer 0.1 s and the handshake one try: a machine that is busy elsewhere gets more time, and again.
  double duration = GetParam() == "tcp" ? 2.0 : 3.5;
  for (; duration < 16.0 && scans.size() < 8; duration *= 2.0) scans = grab(folder, duration);
  // The handshake takes 0.2 s over TCP and about a second over a serial line.
  ASSERT_GE(scans.size(), 8u);
  for (std::size_t i = 1; i < scans.size(); ++i)
    EXPECT_EQ(number_of(scans[i]), number_of(scans[i - 1]) + 1) << "a turn is missing";
  const double period = (scans.back().stamp - scans.front().stamp) / static_cast<double>(scans.size() - 1);
  EXPECT_NEAR(period, 0.1, 0.003);
  std::cout << GetParam() << ": " << scans.size() << " scans, " << 1.0 / period << " a second\n";
  fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Both, RawlogGrabber, testing::Values("tcp", "pty"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace rubble::robot
