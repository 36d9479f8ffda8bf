// MRPT's own driver of Hokuyo scanners against the emulated one: it must accept it, and our wrapper must put its
// bearings and stamps right.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <thread>
#include <vector>

#include "base/angle.h"
#include "base/error.h"
#include "robot/drivers/host_clock.h"
#include "robot/drivers/mrpt_scanner.h"
#include "robot/emulators/scip/urg_emulator.h"
#include "tests/support/machine_witness.h"
#include "tests/support/robot_turning_scene.h"

namespace rubble::robot {
namespace {

namespace fs = std::filesystem;

class MrptWire : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "mrptXXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
};

TEST_P(MrptWire, BearingsAreTheTruthAtBothEndsAndStampsAreNear) {
  UrgEmulatorConfig device;
  device.port = GetParam() == "tcp" ? "tcp:127.0.0.1:0" : "pty:" + (folder_ / "urg").string();
  UrgEmulator emulator(device);
  TurningScene scene(device.laser, [&](const LaserScan& scan) { emulator.publish(scan); });
  MrptScannerConfig config;
  config.port = emulator.port();
  const auto scanner = mrpt_scanner(config);
  const Witness machine;  // no stamp can be better than it is late
  std::vector<LaserScan> scans;
  for (const Stamp end = host_now() + 6.0; host_now() < end && scans.size() < 6; sleep_until(host_now() + 0.02))
    for (LaserScan& scan : scanner->take()) scans.push_back(std::move(scan));
  ASSERT_GE(scans.size(), 6u) << scanner->status().error;
  const double tolerance = deg_to_rad(0.05);
  for (const LaserScan& scan : scans) {
    const int number = number_of(scan);
    const LaserScan truth = numbered_scan({}, number, Stamp{});
    ASSERT_EQ(scan.ranges.size(), truth.ranges.size());
    const std::size_t last = scan.ranges.size() - 1;
    EXPECT_NEAR(scan.bearing(0), truth.bearing(0), tolerance);
    EXPECT_NEAR(scan.bearing(340), 0.0, tolerance);
    EXPECT_NEAR(scan.bearing(last), truth.bearing(last), tolerance);
    // Ranges say which beam is which: each differs from its neighbours.
    for (std::size_t i = 0; i <= last; ++i) {
      if (i == 100 || i == 200) continue;
      EXPECT_NEAR(static_cast<double>(scan.ranges[i]), static_cast<double>(truth.ranges[i]), 1e-6) << i;
    }
    EXPECT_TRUE(std::isnan(scan.ranges[100]));
    EXPECT_TRUE(std::isnan(scan.ranges[200]));
    EXPECT_NEAR(scan.stamp - scene.stamp(number), 0.0, 0.05 + machine.worst()) << number;
  }
  std::cout << GetParam() << ": stamp error " << (scans.back().stamp - scene.stamp(number_of(scans.back()))) * 1e3
            << " ms, delivery after the last beam " << scanner->status().latency * 1e3 << " ms\n";
  EXPECT_THAT(scanner->info().model, testing::HasSubstr("URG-04LX"));
  EXPECT_EQ(scanner->info().laser.beams, 682);
}

INSTANTIATE_TEST_SUITE_P(Both, MrptWire, testing::Values("tcp", "pty"), [](const auto& info) { return info.param; });

TEST(MrptScanner, UnknownTypeIsRefusedInOneLine) {
  MrptScannerConfig config;
  config.type = "CNoSuchLaser";
  try {
    mrpt_scanner(config);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("'CNoSuchLaser': MRPT has no such scanner"));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

TEST(MrptScanner, OtherScannersOfMrptAreMade) {
  for (const char* type : {"CSickLaserSerial", "CLMS100Eth", "CRoboPeakLidar"}) {
    MrptScannerConfig config;
    config.type = type;
    config.port = "/dev/no-such-scanner";
    config.parameters = {{"ip_address", "127.0.0.1"}, {"port", "1"}};
    const auto scanner = mrpt_scanner(config);
    for (const Stamp end = host_now() + 2.0; host_now() < end && scanner->status().error.empty();)
      sleep_until(host_now() + 0.02);
    EXPECT_FALSE(scanner->status().connected) << type;
    std::cout << type << ": " << scanner->status().error << "\n";
    EXPECT_EQ(scanner->status().error.find('\n'), std::string::npos);
  }
}

TEST(MrptScanner, ReducedFieldOfViewIsRefused) {
  MrptScannerConfig config;
  config.port = "/dev/no-such-scanner";
  config.parameters = {{"reduced_fov", "90"}};
  EXPECT_THROW(mrpt_scanner(config), InputError);
}

}  // namespace
}  // namespace rubble::robot
