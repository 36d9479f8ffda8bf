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

  RobotFile load(const std::string& yaml) {
    const std::string path = (folder_ / "robot.yaml").string();
    std::ofstream(path) << yaml;
    return load_robot_file(path);
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

}  // namespace
}  // namespace rubble::scenarios
