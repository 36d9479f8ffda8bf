#pragma once

#include <mrpt/math/TPose3D.h>

#include <string>
#include <vector>

#include "base/trajectory.h"
#include "robot/logs/foreign/foreign_log.h"
#include "robot/measurements.h"
#include "robot/model.h"

namespace mrpt::obs {
class CObservation2DRangeScan;
class CObservationOdometry;
}  // namespace mrpt::obs

namespace rubble::robot {

/// Our scan as MRPT's: the sensor pose takes up the part of the bearings that is not symmetric about the laser's x
/// axis. Returns keep their bits and are valid; a miss becomes the maximum range, invalid; no measurement becomes 0,
/// invalid. Lost: beam_period, range_min, angles beyond float precision, time below 100 ns.
void to_mrpt(const LaserScan& scan, const mrpt::math::TPose3D& T_base_laser, mrpt::obs::CObservation2DRangeScan& out);
/// The inverse for the same mount; beam_period = range_min = 0.
LaserScan from_mrpt(const mrpt::obs::CObservation2DRangeScan& scan, const mrpt::math::TPose3D& T_base_laser);

/// Lost: `stalled`, time below 100 ns, whole turns of the heading.
void to_mrpt(const Odometry& odometry, mrpt::obs::CObservationOdometry& out);
Odometry from_mrpt(const mrpt::obs::CObservationOdometry& odometry);

/// Writes laser scans and odometry as an MRPT .rawlog in observation-only form, labels LASER and ODOMETRY, sorted by
/// stamp; no IMU entries (they spoil icp-slam's map). A comment entry at the end carries the robot model, so that
/// read_rawlog() gives back what MRPT's types cannot hold. Debian's rawlog-edit and icp-slam open it.
/// The source is any log ReplayRobot reads. Throws InputError for it, RunError when the rawlog cannot be written.
void export_rawlog(const std::string& log_path, const std::string& rawlog_path);

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
