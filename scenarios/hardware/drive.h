#pragma once

#include <functional>
#include <optional>
#include <string>

#include "robot/commands.h"
#include "robot/drivers/real_robot.h"
#include "robot/measurements.h"
#include "scenarios/hardware/robot_file.h"
#include "scenarios/run/run.h"

namespace rubble::scenarios {

/// Who drives.
enum class DriveMode { Explore, Teleoperate, MapOnly, Calibrate };

/// What the terminal shows once a second.
struct DriveStatus {
  double seconds = 0.0;  ///< since the first tick
  std::string state;     ///< what the robot is doing, in one word or two
  mrpt::math::TPose2D T_map_base;
  double known_m2 = 0.0;
  bool has_base = true;  ///< that we are connected with
  robot::RobotStatus robot;
  double scans_per_s = 0.0;  ///< over the last second
  double odometry_per_s = 0.0;
  double accelerations_per_s = 0.0;
};

struct DriveOptions {
  DriveMode mode = DriveMode::Explore;
  std::string out;
  bool replace = false;
  std::string notice;  ///< told once, as soon as the ports are ours; empty: nothing
  /// These four are asked in a thread of their own (see RealRobot::listen) about fifty times a second.
  std::function<bool()> interrupted;   ///< true stops the robot and ends the run
  std::function<bool()> emergency;     ///< true stops hard and ends the run
  std::function<bool()> insisted;      ///< true: the base is left at once, then `left` is called
  std::function<void()> left;          ///< ends the program
  std::function<bool()> rearm;         ///< asked while the robot is held by its own buttons; true lets it go
  std::function<void()> forget_keys;   ///< called while devices are waited for: what was pressed then drives nothing
  std::function<robot::Drive()> keys;  ///< what the operator wants (Teleoperate)
  /// What comes next (Calibrate), told where the mapper takes the robot to be; nothing ends the drive.
  std::function<std::optional<robot::Drive>(const robot::Inputs&, const mrpt::math::TPose2D& T_map_base)> pilot;
  std::function<std::string()> pilot_trouble;  ///< why the pilot ended the drive early; empty: it did not
  std::function<void(const DriveStatus&)> each_second;
  std::function<void(const std::string&)> tell;               ///< a device was lost or came back: one line
  std::function<void(const std::string& folder)> incomplete;  ///< before an exception that leaves the folder so
};

/// Drives a real robot: explores (or lets somebody drive) and maps. The run folder is that of run_scenario(), with all
/// raw bytes of the devices in devices.bytes. Throws InputError, RunError; a robot or mapper that is lost on the way is
/// told in the report, its folder is complete.
RunReport drive(const RobotFile& file, const DriveOptions& options);

}  // namespace rubble::scenarios
