#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "robot/logs/foreign/foreign_log.h"

namespace rubble::robot {

/// One ODOM, FLASER or ROBOTLASER1 line.
struct CarmenRecord {
  int line = 0;
  bool is_scan = false;
  Stamp measured;             ///< the sender's stamp
  Stamp logged;               ///< the logger's stamp
  Stamp stamp;                ///< in order, set by read_carmen
  mrpt::math::TPose2D robot;  ///< the robot's pose as the line gives it
  mrpt::math::TPose2D laser;  ///< the laser's pose as the line gives it (scans only)
  double v = 0.0;             ///< [m/s] (ODOM and ROBOTLASER1)
  double w = 0.0;             ///< [rad/s]
  LaserScan scan;             ///< stamp left to the reader of the records
};

/// What a CARMEN text log says, line by line.
struct CarmenText {
  std::vector<CarmenRecord> records;
  std::optional<double> front_laser_offset;  ///< of the laser ahead of the robot's centre [m]
  std::optional<double> robot_length;        ///< [m]
  std::optional<double> robot_width;         ///< [m]
  std::vector<std::string> notes;            ///< as in ForeignLog
};

/// True when the first lines look like a CARMEN text log.
bool is_carmen(std::string_view text);

/// Parses the lines; other messages and comments are passed over. Throws InputError `path:line:column: ...`.
CarmenText parse_carmen(std::string_view text, const std::string& path);

/// Reads a whole log: sorts out which of its poses are raw odometry and which are corrected reference poses
/// (docs/robot.md says how). Throws InputError.
ForeignLog read_carmen(std::string_view text, const std::string& path);

}  // namespace rubble::robot
