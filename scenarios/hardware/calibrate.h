#pragma once

#include <limits>
#include <string>

#include "scenarios/hardware/calibration_drive.h"
#include "scenarios/hardware/drive.h"
#include "scenarios/hardware/robot_file.h"
#include "slam/calibration/calibration.h"

namespace rubble::scenarios {

/// A robot file with the numbers that a drive gave, and how sure they are.
struct CalibratedRobot {
  RobotFile file;
  slam::Calibration calibration;  ///< relative to what was in force during the drive
  slam::RobotSetup setup;         ///< as it stands in the file now
  /// Wheel travel to and fro over true turn [m]; NaN: not known, the log has no wheel speeds.
  double effective_track = std::numeric_limits<double>::quiet_NaN();
  double effective_track_sigma = std::numeric_limits<double>::quiet_NaN();  ///< [m]
};

/// Drives squares and turns as drive() would with that file, but holds the servos at zero. Why the pilot gave up stands
/// in the report's `failure`.
RunReport calibration_drive(const RobotFile& file, const CalibrationDriveConfig& config, const DriveOptions& options);

/// Estimates from a log. `in_force`: the robot file it was recorded with; `file`: what the numbers are put into.
/// Throws InputError when the log tells too little.
CalibratedRobot calibrate_from_log(const std::string& log, const RobotFile& in_force, const RobotFile& file);

/// The calibrated file as text: the uncertainties as comments, then what load_robot_file reads.
std::string calibrated_yaml(const CalibratedRobot& robot, const std::string& log);

}  // namespace rubble::scenarios
