#pragma once

#include <string>
#include <vector>

#include "robot/measurements.h"
#include "robot/model.h"

namespace rubble::robot {

/// Writes laser scans and odometry as an MRPT .rawlog in observation-only form, labels LASER and ODOMETRY, sorted by
/// stamp; no IMU entries (they spoil icp-slam's map). Debian's rawlog-edit and icp-slam open it. Throws RunError.
/// The source is one of our own logs.
void export_rawlog(const std::string& log_path, const std::string& rawlog_path);

/// Reads an MRPT .rawlog (observation-only or action/frame form) into ticks of inputs; fills the laser part of `model`.
/// Throws InputError.
std::vector<Inputs> read_rawlog(const std::string& path, RobotModel& model);

}  // namespace rubble::robot
