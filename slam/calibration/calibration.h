#pragma once

#include <optional>
#include <string>
#include <vector>

#include "robot/measurements.h"
#include "robot/model.h"
#include "slam/calibration/level_zero.h"
#include "slam/calibration/robot_setup.h"

namespace rubble::slam {

/// What a drive told of a robot.
struct Calibration {
  /// Why the rest must not be used, and what helps; empty: it may.
  std::string refusal;
  RobotSetup setup;
  RobotSetup sigma;  ///< standard deviations; T_base_laser: of x, y, phi
  std::optional<LevelZero> level;
  double driven = 0.0;  ///< true way [m]
  double turned = 0.0;  ///< true turn, to and fro [rad]
  int scans = 0;        ///< that were laid on others
  int stretches = 0;
  double position_error = 0.0;  ///< of a scan against the calibrated wheels, middle of all [m]
  double turn_error = 0.0;      ///< [rad]
};

/// Collects a drive and estimates the setup from it: how far wheels' scales, the laser's mount and delay are from what
/// they were taken for when the drive was recorded, and where the accelerometer's zero is.
class Calibrator {
 public:
  void add(const robot::Inputs& inputs);
  /// `taken_for`: the mount and delay in force during the drive; its scales are 1, for odometry is recorded as scaled
  /// then. A pure function of what was added.
  Calibration calibrate(const RobotSetup& taken_for, robot::AccelerometerMount mount) const;

 private:
  WheelTrack wheels_;
  std::vector<robot::LaserScan> scans_;
  std::vector<robot::Acceleration> accelerations_;
  std::vector<robot::AimState> aims_;
};

}  // namespace rubble::slam
