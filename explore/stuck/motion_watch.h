#pragma once

#include <mrpt/math/TPose2D.h>

#include <cmath>

#include "base/angle.h"
#include "robot/commands.h"

namespace rubble::explore {

struct MotionWatchConfig {
  double moved = 0.05;              ///< this far from where the watch began, the robot moves [m]
  double turned = deg_to_rad(8.0);  ///< or turned this much [rad]
  double patience = 0.20;           ///< way commanded in vain that means stuck [m]
  double pivot_rate = 0.15;         ///< turning faster than this
  double pivot_speed = 0.12;        ///< and driving no faster is a turn on the spot: its way does not count
  double accel = 0.3;               ///< a commanded speed is expected to be reached so [m/s^2]
  double turn_patience = 1.6;       ///< turn commanded in vain that means stuck [rad]
  double place = 0.15;              ///< rocking to and fro within so much of a place [m]
  double place_patience = 0.45;     ///< way commanded there that means stuck, though the pose trembles [m]
  double rocking = 6.3;             ///< turned so much more there than came of it means stuck [rad]
  double stall_time = 0.21;         ///< the motors report a stall for this long [s]
};

/// Finds out that the robot is stuck: it is told to move, but its pose stays or its motors stall.
class MotionWatch {
 public:
  explicit MotionWatch(const MotionWatchConfig& config = {}) : config_(config) {}

  /// One tick of `dt` seconds under the command that was in force; true when the robot is stuck.
  bool stuck(const mrpt::math::TPose2D& T_map_base, const robot::Drive& commanded, bool stalled, double dt);
  /// Begins anew, e.g. after the robot freed itself.
  void reset();
  /// A turn that is meant to stay in its place, to look round, is under way.
  void turns_on_purpose() { rocked_ = net_ = 0.0; }
  /// It turns to and fro and gets nowhere: something holds one of its corners.
  bool rocking() const { return rocked_ - std::abs(net_) > config_.rocking; }
  /// Whether a command is a turn on the spot.
  bool on_the_spot(const robot::Drive& commanded) const {
    return std::abs(commanded.w) > config_.pivot_rate && std::abs(commanded.v) <= config_.pivot_speed;
  }

 private:
  MotionWatchConfig config_;
  mrpt::math::TPose2D reference_;
  bool has_reference_ = false;
  double expected_ = 0.0;  ///< speed [m/s]
  double way_ = 0.0;
  double turn_ = 0.0;
  mrpt::math::TPose2D place_;
  double pushed_ = 0.0;  ///< way commanded there [m]
  double rocked_ = 0.0;  ///< turns commanded there, whichever way [rad]
  double net_ = 0.0;     ///< what came of them [rad]
  double last_phi_ = 0.0;
  double stalled_for_ = 0.0;
};

}  // namespace rubble::explore
