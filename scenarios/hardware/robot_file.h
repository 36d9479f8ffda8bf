#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "robot/drivers/real_robot.h"
#include "scenarios/config/scenario.h"

namespace rubble::scenarios {

/// Who talks to the scanner: our own driver, or one of MRPT's.
enum class LidarDriver { Scip, Mrpt };

/// What a robot file calls the driver of the levelling unit, and none.
inline constexpr const char* kLevellingUnit = "lev1";
inline constexpr const char* kNoLevelling = "none";

/// The scanner of a robot file.
struct LidarSettings {
  LidarDriver driver = LidarDriver::Scip;
  std::string mrpt_class = "CHokuyoURG";  ///< which of MRPT's drivers
  std::string port;
  std::vector<std::pair<std::string, std::string>> parameters;  ///< of MRPT's configuration section, passed through
  double delay = 0.0;                                           ///< scans are so much older than their stamps say [s]
  bool upside_down = false;     ///< it hangs from its mount: its beams run clockwise seen from above
  bool no_echo_is_miss = true;  ///< "no echo" counts as nothing in range, else as no measurement; MRPT: false
};

/// A real robot: devices, ports, mounts and limits, and how the core shall use them.
struct RobotFile {
  LidarSettings lidar;
  robot::RealRobotSettings robot;  ///< its model is settings.robot
  Scenario settings;               ///< mapper, explorer, levelling, robot model; no arena
};

/// What the driver gave, as the robot file says that the scanner hangs and how old its scans are.
void as_mounted(const LidarSettings& lidar, robot::LaserScan& scan);

/// Reads a robot file strictly. Throws InputError.
RobotFile load_robot_file(const std::string& path, const std::vector<Override>& overrides = {});

/// The file as YAML that load_robot_file reads back to the same settings.
std::string robot_file_yaml(const RobotFile& file);

}  // namespace rubble::scenarios
