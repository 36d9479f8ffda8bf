#pragma once

#include <string>
#include <vector>

#include "base/trajectory.h"
#include "robot/measurements.h"
#include "robot/model.h"

namespace rubble::robot {

/// A scan's stamp as delivered and as its log has it.
struct OwnStamp {
  Stamp delivered;
  Stamp in_log;
};

/// A log of another program, brought into our terms.
struct ForeignLog {
  std::string format;
  RobotModel model;
  std::vector<Inputs> ticks;
  Trajectory reference;  ///< T_map_base at the scans' reference times; empty when the log has none
  /// What the log itself calls the scans, where a jittering clock made them be delivered with other stamps.
  std::vector<OwnStamp> own_stamps;
};

/// How far a stamp may lie before an earlier one of the same list and still count as jitter of the recorder [s].
constexpr double kStampJitter = 2.0;

/// Stamps for measurements that keep the order of their lines: the same stamps sorted, equal ones set 1 us apart.
/// A jittering clock would otherwise make the odometry run to and fro.
std::vector<Stamp> sorted_stamps(std::vector<Stamp> stamps);

/// Deals the measurements of a log out in ticks as a robot would deliver them: a tick ends when the first odometry at
/// or after the middle of a scan has arrived, so that the scan's pose can be interpolated; scans behind the last
/// odometry come in a last tick. Sorts both lists by stamp; of odometry with equal stamps the last one stays. Before
/// its first odometry the robot stands still; without any it stands still throughout.
std::vector<Inputs> assemble_ticks(std::vector<LaserScan> scans, std::vector<Odometry> odometry);

/// Describes the scanner by its first scan and sets the periods to the median spacing of scans and odometry.
void describe_sensors(const std::vector<LaserScan>& scans, const std::vector<Odometry>& odometry, RobotModel& model);

}  // namespace rubble::robot
