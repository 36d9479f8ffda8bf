// Finding devices: who answers at a port, and a scan as text.
#include "robot/drivers/probe/probe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <limits>
#include <thread>

#include "base/angle.h"
#include "base/error.h"
#include "robot/drivers/host_clock.h"
#include "robot/emulators/arcos_emulator.h"
#include "robot/emulators/device_server.h"
#include "robot/emulators/levelling_emulator.h"
#include "robot/emulators/port_server.h"
#include "robot/emulators/scip/urg_emulator.h"
#include "robot/robot.h"
#include "tests/support/robot_turning_scene.h"

namespace rubble::robot {
namespace {

namespace fs = std::filesystem;

std::string fact(const FoundDevice& found, const std::string& name) {
  for (const auto& [key, value] : found.facts)
    if (key == name) return value;
  return "";
}

TEST(Probe, ScannerTellsWhoItIsAndWhatItSees) {
  UrgEmulatorConfig config;
  config.port = "tcp:127.0.0.1:0";
  UrgEmulator emulator(config);
  const TurningScene scene(config.laser, [&](const LaserScan& scan) { emulator.publish(scan); });
  const auto found = probe_port(emulator.port());
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kind, DeviceKind::Scanner);
  EXPECT_EQ(found->called, "laser scanner");
  EXPECT_EQ(fact(*found, "model"), "URG-04LX(Hokuyo Automatic Co.,Ltd.)");
  EXPECT_THAT(fact(*found, "firmware"), testing::StartsWith("3.3.00"));
  EXPECT_EQ(fact(*found, "ranges"), "0.02 to 5.60 m");
  EXPECT_EQ(fact(*found, "beams"), "682 from -119.53 to 119.88 deg");
  EXPECT_EQ(fact(*found, "state"), "Sensor works well.");
  ASSERT_TRUE(found->scan);
  EXPECT_EQ(found->scan->ranges.size(), 682u);
}

/// Serves an emulated device and feeds it until it is destroyed.
template <typename Feed>
class Fed {
 public:
  Fed(DeviceServer& server, Feed feed)
      : thread_([this, &server, feed] {
          for (; !ending_; sleep_until(host_now() + 0.02)) server.with(feed);
        }) {}
  ~Fed() {
    ending_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

TEST(Probe, BaseTellsWhoItIsAndStandsStill) {
  ArcosEmulatorSettings settings;
  settings.configuration.firmware = "7.5";
  ArcosEmulator base(settings);
  DeviceServer server("tcp:127.0.0.1:0", base, 1);
  const Fed feed(server, [&] { base.measure({host_now(), {}, 0.0, 0.0, false}, host_now()); });
  const auto found = probe_port(server.port());
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kind, DeviceKind::Base);
  EXPECT_EQ(found->called, "robot base (ARCOS)");
  EXPECT_EQ(fact(*found, "type"), "Pioneer p3at-sh");
  EXPECT_EQ(fact(*found, "firmware"), "7.5") << "as CONFIG tells it, not what the emulator has unless told otherwise";
  EXPECT_THAT(fact(*found, "battery"), testing::EndsWith(" V"));
  server.with([&] { EXPECT_FALSE(base.motors_on()); });
}

TEST(Probe, LevellingUnitTellsWhoItIsAndWhatItFeels) {
  LevellingEmulator unit({});
  DeviceServer server("tcp:127.0.0.1:0", unit, 1);
  const Fed feed(server, [&] { unit.measure({host_now(), 1.0, -0.5}, {host_now(), 0.0, 0.0}, host_now()); });
  const auto found = probe_port(server.port());
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kind, DeviceKind::Levelling);
  EXPECT_EQ(found->called, "levelling unit");
  EXPECT_EQ(fact(*found, "model"), "LEV1");
  EXPECT_EQ(fact(*found, "feels"), "1.00 m/s^2 forward, -0.50 m/s^2 left");
  server.with([&] { EXPECT_FALSE(unit.servos_on()) << "who only asks moves nothing"; });
}

TEST(Probe, SilentPortIsNoDeviceAndAClosedOneIsLost) {
  std::string name;
  {
    const auto server = serve_port("tcp:127.0.0.1:0");
    name = server->name();
    EXPECT_FALSE(probe_port(name));
  }
  EXPECT_THROW(probe_port(name), DeviceLost);
  EXPECT_THROW(probe_port("nonsense"), InputError);
}

TEST(Probe, SerialLinesAreNamedOnceByTheirLastingName) {
  std::string folder = (fs::temp_directory_path() / "devXXXXXX").string();
  ASSERT_NE(::mkdtemp(folder.data()), nullptr);
  fs::create_directories(folder + "/serial/by-id");
  for (const char* name : {"ttyUSB0", "ttyUSB1", "ttyACM0", "tty0", "null"}) std::ofstream(folder + "/" + name) << "";
  fs::create_symlink("../../ttyACM0", folder + "/serial/by-id/usb-Hokuyo");
  EXPECT_THAT(serial_lines(folder),
              testing::ElementsAre(folder + "/serial/by-id/usb-Hokuyo", folder + "/ttyUSB0", folder + "/ttyUSB1"));
  EXPECT_TRUE(serial_lines(folder + "/nowhere").empty());
  fs::remove_all(folder);
}

/// A wall ahead at 2 m, from 45 deg right to 45 deg left; behind it nothing is known.
LaserScan wall_ahead() {
  LaserScan scan;
  scan.angle_min = deg_to_rad(-90.0);
  scan.angle_step = deg_to_rad(0.5);
  for (std::size_t i = 0; i < 361; ++i) {
    const double bearing = scan.bearing(i);
    const bool on_wall = std::abs(bearing) < deg_to_rad(45.0);
    scan.ranges.push_back(on_wall ? static_cast<float>(2.0 / std::cos(bearing))
                                  : std::numeric_limits<float>::quiet_NaN());
  }
  return scan;
}

TEST(ScanPicture, WallAheadIsALineAboveTheScanner) {
  const std::string picture = scan_picture(wall_ahead(), 4.0, 16);
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < picture.size(); at = picture.find('\n', at) + 1)
    lines.push_back(picture.substr(at, picture.find('\n', at) - at));
  ASSERT_EQ(lines.size(), 16u);
  // 0.5 m a row: the wall at 2 m is four rows above the middle, 4 m wide, 0.25 m a column.
  const std::string& wall = lines[4].empty() || lines[4].find('#') == std::string::npos ? lines[3] : lines[4];
  EXPECT_GE(std::count(wall.begin(), wall.end(), '#'), 15);
  EXPECT_EQ(lines[8].substr(0, 17), std::string(16, ' ') + "^");
  for (std::size_t row = 9; row < 16; ++row) EXPECT_EQ(lines[row], "") << "nothing is known behind";
}

TEST(ScanPicture, SummaryNamesTheNearest) {
  LaserScan scan = wall_ahead();
  scan.ranges[90] = 0.5f;
  EXPECT_THAT(scan_summary(scan), testing::HasSubstr("nearest 0.500 m at -45.0 deg"));
  for (float& range : scan.ranges) range = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(scan_summary(scan), testing::HasSubstr("none measured"));
}

}  // namespace
}  // namespace rubble::robot
