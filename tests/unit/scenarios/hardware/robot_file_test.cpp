// The robot file: what it says reaches the drivers, and comes back from the file that a run keeps.
#include "scenarios/hardware/robot_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::Pair;

class RobotFileTest : public testing::Test {
 protected:
  RobotFileTest() {
    std::string name = (fs::temp_directory_path() / "filesXXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~RobotFileTest() override { fs::remove_all(folder_); }

  RobotFile load(const std::string& yaml, const std::vector<Override>& overrides = {}) {
    const std::string path = (folder_ / "robot.yaml").string();
    std::ofstream(path) << yaml;
    return load_robot_file(path, overrides);
  }

 private:
  fs::path folder_;
};

TEST_F(RobotFileTest, MrptsParametersArePassedThroughAndKept) {
  const std::string yaml =
      "devices:\n  urg:\n    driver: mrpt\n    class: CSickLaserSerial\n"
      "    parameters: {COM_baudRate: 38400, mm_mode: \"true\"}\n";
  const RobotFile file = load(yaml);
  EXPECT_THAT(file.lidar.parameters, ElementsAre(Pair("COM_baudRate", "38400"), Pair("mm_mode", "true")));
  EXPECT_EQ(load(robot_file_yaml(file)).lidar.parameters, file.lidar.parameters);
}

TEST_F(RobotFileTest, ParametersWithoutMrptsDriverAreRefused) {
  try {
    load("devices:\n  urg:\n    parameters: {mm_mode: 1}\n");
    FAIL() << "passed";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("driver: mrpt"));
  }
}

TEST_F(RobotFileTest, APermittedSilenceIsPermittedByTheDriversToo) {
  const RobotFile file = load("safety: {base_silence_s: 7, levelling_silence_s: 4}\n");
  EXPECT_GE(file.robot.base.silence, 7.0);
  EXPECT_GE(file.robot.levelling.silence, 4.0);
}

/// No driver tells of victims.
TEST_F(RobotFileTest, ARealRobotHasNeitherMicrophonesNorAProbe) {
  for (const char* yaml : {"safety: {}\n", "sim: {microphones: true, co2_probe: true}\n"}) {
    const RobotFile file = load(yaml);
    EXPECT_FALSE(file.settings.sim.microphones || file.settings.sim.co2_probe) << yaml;
    const RobotFile kept = load(robot_file_yaml(file));
    EXPECT_FALSE(kept.settings.sim.microphones || kept.settings.sim.co2_probe) << yaml;
  }
}

TEST_F(RobotFileTest, WhatMountHallAndBatteryAreIsKept) {
  const RobotFile usual = load("name: here\n");
  EXPECT_FALSE(usual.lidar.upside_down);
  EXPECT_TRUE(usual.robot.safety.mount_check && usual.robot.safety.scans.nothing_holds);
  const RobotFile file = load(
      "devices: {urg: {upside_down: true}}\nsafety: {mount_check: false, sees_nothing_holds: false, sees_nothing_m: "
      "20, "
      "battery_low_v: 23, battery_empty_v: 22}\n");
  const RobotFile kept = load(robot_file_yaml(file));
  EXPECT_TRUE(kept.lidar.upside_down);
  EXPECT_FALSE(kept.robot.safety.mount_check || kept.robot.safety.scans.nothing_holds);
  EXPECT_EQ(kept.robot.safety.scans.nothing_way, 20.0);
  EXPECT_EQ(kept.robot.safety.battery_low, 23.0);
  EXPECT_EQ(kept.robot.safety.battery_empty, 22.0);
}

/// A word that ends in a colon is a map to YAML, which is not what is wrong with it.
TEST_F(RobotFileTest, APortThatIsNoneIsNamedAsOne) {
  for (const std::string device : {"urg", "base", "levelling"}) {
    const std::string key = "devices." + device + ".port";
    for (const auto& [word, why] : {std::pair<std::string, std::string>{"tcp:127.0.0.1:", "is no port number"},
                                    {"tcp:127.0.0.1", "host or port number is missing"},
                                    {"tcp:127.0.0.1:70000", "is no port number"},
                                    {"tcp:127.0.0.1:0", "nobody can be reached at port number 0"},
                                    {"pty:", "the path is missing"},
                                    {"ttyUSB0", "is no port"}}) {
      try {
        load("name: here\n", {{key, word}});
        ADD_FAILURE() << word << " passed";
      } catch (const InputError& error) {
        EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("--set " + key), testing::HasSubstr(why)));
      }
      try {
        load("devices:\n  " + device + ":\n    port: \"" + word + "\"\n", {});
        ADD_FAILURE() << word << " passed";
      } catch (const InputError& error) {
        EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("robot.yaml:3"), testing::HasSubstr(why)));
      }
    }
  }
  EXPECT_EQ(load("name: here\n", {{"devices.base.driver", "none"}, {"devices.base.port", "nowhere"}}).robot.base_port,
            "");
}

TEST_F(RobotFileTest, OnePortForTwoDevicesIsRefusedByBothNames) {
  const auto refuses = [&](const std::vector<Override>& overrides, const std::string& why) {
    try {
      load("name: here\n", overrides);
      ADD_FAILURE() << why << ": passed";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(why));
    }
  };
  refuses({{"devices.urg.port", "/dev/ttyUSB0"}}, "devices.urg and devices.base have the same port '/dev/ttyUSB0'");
  refuses({{"devices.base.port", "tcp:127.0.0.1:9"}, {"devices.levelling.port", "tcp:127.0.0.1:9"}},
          "devices.base and devices.levelling have the same port");
  refuses({{"devices.urg.port", "/dev/null"}, {"devices.levelling.port", "/dev/../dev/null"}},
          "devices.urg and devices.levelling have the same port");
  EXPECT_NO_THROW(load("name: here\n", {{"devices.urg.port", "/dev/ttyUSB0"}, {"devices.base.driver", "none"}}));
  EXPECT_NO_THROW(load("name: here\n", {{"devices.urg.port", "/dev/ttyUSB1"}, {"devices.levelling.driver", "none"}}));
}

}  // namespace
}  // namespace rubble::scenarios
