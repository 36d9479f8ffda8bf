#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstdint>

#include "base/stamp.h"
#include "robot/commands.h"
#include "robot/measurements.h"
#include "robot/model.h"
#include "sim/body/drive.h"

namespace rubble::sim {

/// The robot's motion controller: turns set points into rim speeds (trapezoids), counts encoder ticks, reckons the
/// pose, notices stalls, and stops when commands stay away. Behaves as ARCOS on a Pioneer (its public manual): x and y
/// are reported in whole mm, the heading in 4096ths of a turn, speeds in mm/s.
class Firmware {
 public:
  explicit Firmware(const robot::RobotModel& model) : model_(model) {}

  void command(const robot::Drive& drive);
  /// Without a ramp, as hard as motors and floor allow: motors switched off, or an emergency stop.
  void brake();
  /// Advances the set points by `dt` and says what the motors shall do.
  SideDemand demand(double dt);
  /// Takes in what the wheels did in this step.
  void observe(const Side& left, const Side& right, double dt);
  /// One cycle of dead reckoning from the ticks counted since the last, and its report.
  robot::Odometry reckon(Stamp stamp);

  bool stalled() const { return stalled_; }
  /// What the motors work for now: on the way to the command, or to rest where commands stay away.
  robot::Drive set_point() const { return {v_, w_}; }

 private:
  robot::RobotModel model_;
  robot::Drive target_;
  double v_ = 0.0;  ///< set point now [m/s]
  double w_ = 0.0;  ///< [rad/s]
  double silence_ = 0.0;
  SideDemand demand_;
  double left_speed_ = 0.0;
  double right_speed_ = 0.0;
  std::int64_t left_ticks_ = 0;
  std::int64_t right_ticks_ = 0;
  std::int64_t last_left_ticks_ = 0;
  std::int64_t last_right_ticks_ = 0;
  double pushing_ = 0.0;     ///< a side has pushed without turning for so long [s]
  double relax_ = 0.0;       ///< motors stay off for so long [s]
  double since_push_ = 0.0;  ///< [s]
  bool stalled_ = false;
  mrpt::math::TPose2D reckoned_;  ///< in the odometry frame, not rounded
};

}  // namespace rubble::sim
