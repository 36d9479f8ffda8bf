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
  std::vector<std::string> notes;  ///< what was assumed against the log or without it, for people: a line each
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

/// The range from which on a log's readings mean "no echo", for logs that do not say it: many scanners write one large
/// number there (8.19, 50, 81.91 m), and read as hits these are a wall that goes with the robot. Told by a pile: the
/// readings within 1.5 % of the largest one are at least 20 and of at least 5 beams, one number makes up half of them
/// or more, and they lie four times as densely as those down to 85 % of it. Infinity where there is no such pile [m].
double no_echo_from(const std::vector<LaserScan>& scans);

/// Turns the readings from `limit` on into misses, and the scanner's range into at most `limit`.
void take_as_misses(double limit, std::vector<LaserScan>& scans);

/// Describes the scanner by its first scan and sets the periods to the median spacing of scans and odometry.
void describe_sensors(const std::vector<LaserScan>& scans, const std::vector<Odometry>& odometry, RobotModel& model);

}  // namespace rubble::robot
