#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/math/TPose3D.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/poses/CPose3D.h>

#include <string>
#include <string_view>
#include <vector>

#include "base/trajectory.h"
#include "robot/logs/foreign/foreign_log.h"
#include "robot/measurements.h"
#include "robot/model.h"

namespace rubble::robot {

/// What an mrpt::obs::CObservation2DRangeScan holds.
struct MrptScan {
  mrpt::Clock::time_point time;
  mrpt::poses::CPose3D T_base_sensor;
  float aperture = 0.0f;   ///< from the middle of the first to the middle of the last beam [rad]
  float range_max = 0.0f;  ///< [m]
  bool right_to_left = true;
  std::string label;
  std::vector<float> ranges;  ///< [m]
  std::vector<bool> valid;
};

/// What an mrpt::obs::CObservationOdometry holds; without velocities they are 0.
struct MrptOdometry {
  mrpt::Clock::time_point time;
  mrpt::poses::CPose2D pose;
  double v = 0.0;  ///< [m/s]
  double w = 0.0;  ///< [rad/s]
};

/// The inverse of to_mrpt() (module/to_mrpt.h) for the same mount; beam_period = range_min = 0.
LaserScan from_mrpt(const MrptScan& scan, const mrpt::math::TPose3D& T_base_laser);
Odometry from_mrpt(const MrptOdometry& odometry);

struct ExportedScans {
  std::size_t scans = 0;
  std::size_t renamed = 0;  ///< of these, such that have another stamp than in the log: its clock jitters
};

/// Writes laser scans and odometry as an MRPT .rawlog in observation-only form, labels LASER and ODOMETRY, sorted by
/// stamp; no IMU entries (they spoil icp-slam's map). A comment entry at the end carries the robot model, so that
/// read_rawlog() gives back what MRPT's types cannot hold. Debian's rawlog-edit and icp-slam open it.
/// The source is any log ReplayRobot reads. Throws InputError for it, RunError when the rawlog cannot be written.
ExportedScans export_rawlog(const std::string& log_path, const std::string& rawlog_path);

struct PosedScan {
  LaserScan scan;
  mrpt::math::TPose2D T_map_base;
};

/// Writes scans and where they were taken as MRPT's .simplemap, with gzip as its programs do. Throws RunError.
void write_simplemap(const std::string& path, const std::vector<PosedScan>& scans,
                     const mrpt::math::TPose3D& T_base_laser);

/// Reads an MRPT .rawlog (observation-only or action/frame form) into ticks of inputs; fills the laser part of `model`.
/// Throws InputError.
std::vector<Inputs> read_rawlog(const std::string& path, RobotModel& model);

/// Ground truth beside a rawlog, `<path>.GT.txt` with lines `time x y phi` as MRPT's simulated datasets have it; empty
/// when there is none. Throws InputError with file, line and column.
Trajectory read_rawlog_reference(const std::string& path);

/// True when (inflated) bytes start with a serialized MRPT object.
bool is_rawlog(std::string_view bytes);
/// read_rawlog() of bytes already in memory, with its reference.
ForeignLog read_rawlog_bytes(std::string_view bytes, const std::string& path);

}  // namespace rubble::robot
