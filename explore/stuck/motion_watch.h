#pragma once

#include <mrpt/math/TPose2D.h>

#include <cmath>
#include <deque>
#include <optional>

#include "base/angle.h"
#include "robot/commands.h"

namespace rubble::explore {

struct MotionWatchConfig {
  double patience = 0.20;           ///< over so much way commanded the robot should have moved [m]
  double moved = 0.25;              ///< by more than this share of it, or it is stuck
  double jump = 0.04;               ///< a pose that moves more from tick to tick is corrected: it begins anew [m]
  double scan_time = 0.1;           ///< spinning wheels carry the pose on for so long before a scan puts it back [s]
  double soon = 0.13;               ///< over so much [m]
  double hardly = 0.15;             ///< by more than this; over the crest of a ramp it may slip more than that for long
  double led = 0.6;                 ///< by more than this where it is turned aside: a corner of it hangs on something
  double aside = deg_to_rad(10.0);  ///< turned so much against its wheels, or beyond them [rad]
  double turned = deg_to_rad(8.0);  ///< turned this much on the spot, the robot moves [rad]
  double steered = 1.0;             ///< turned so much by wheels that drive on [rad]
  double unmoved = deg_to_rad(5.0);  ///< while the body turned by no more than this, it is held [rad]
  double pivot_rate = 0.15;          ///< turning faster than this
  double pivot_speed = 0.12;         ///< and driving no faster is a turn on the spot: its way does not count
  double accel = 0.3;                ///< a commanded speed is expected to be reached so [m/s^2]
  double turn_patience = 1.2;        ///< turn commanded in vain that means stuck [rad]
  double rolled = 0.3;               ///< way of wheels that were to turn it meanwhile, in vain as well [m]
  double place = 0.15;               ///< rocking to and fro within so much of a place [m]
  double place_patience = 0.45;      ///< way commanded there that means stuck, though the pose trembles [m]
  double rocking = 6.3;              ///< turned so much more there than came of it means stuck [rad]
  double standing = 0.02;            ///< slower wheels stand [m/s], [rad/s]
  double disobedience = 8.0;         ///< wheels that stand so long though told to go are held [s]
  double stall_time = 0.21;          ///< the motors report a stall for this long [s]
};

/// Finds out that the robot is stuck: it is told to move and its wheels turn, but its pose stays, or its motors stall.
class MotionWatch {
 public:
  explicit MotionWatch(const MotionWatchConfig& config = {}) : config_(config) {}

  /// One tick of `dt` seconds under the command that was in force; true when the robot is stuck. `wheels`: what they
  /// do, where that is known.
  bool stuck(const mrpt::math::TPose2D& T_map_base, const robot::Drive& commanded, bool stalled, double dt,
             const std::optional<robot::Drive>& wheels = std::nullopt);
  /// Begins anew, e.g. after the robot freed itself.
  void reset();
  /// A turn that is meant to stay in its place, to look round, is under way.
  void turns_on_purpose() { rocked_ = net_ = 0.0; }
  /// It turns to and fro and gets nowhere: something holds one of its corners.
  bool rocking() const { return rocked_ - std::abs(net_) > config_.rocking; }
  /// Its wheels turn it as they roll, and its heading stays, wherever its pose seems to go.
  bool steers_in_vain() const { return std::abs(steered_) > config_.steered; }
  /// Whether a command is a turn on the spot.
  bool on_the_spot(const robot::Drive& commanded) const {
    return std::abs(commanded.w) > config_.pivot_rate && std::abs(commanded.v) <= config_.pivot_speed;
  }

 private:
  /// A moment of a drive that is no turn on the spot.
  struct Moment {
    mrpt::math::TPose2D T_map_base;
    double way;   ///< commanded up to then [m]
    double turn;  ///< that the wheels made [rad]
  };

  bool drives_in_vain(const mrpt::math::TPose2D& T_map_base);
  bool in_vain_since(const Moment& then, const mrpt::math::TPose2D& T_map_base, double share) const;

  MotionWatchConfig config_;
  mrpt::math::TPose2D reference_;  ///< of turns on the spot
  bool has_reference_ = false;
  double expected_ = 0.0;  ///< speed [m/s]
  double way_ = 0.0;
  double wheel_turn_ = 0.0;
  std::deque<Moment> lately_;  ///< over the last `patience` of way
  double turn_ = 0.0;          ///< commanded on the spot since the body turned, or the robot got elsewhere [rad]
  double spun_ = 0.0;          ///< by the wheels on the spot since the body turned, wherever its pose slid to [rad]
  double rolled_ = 0.0;        ///< way of the wheels since then, whatever sense, that were to turn it on the spot [m]
  double steered_ = 0.0;       ///< by the wheels since the body turned last [rad]
  double steered_from_ = 0.0;  ///< its heading then [rad]
  mrpt::math::TPose2D place_;
  double pushed_ = 0.0;  ///< way commanded there [m]
  double rocked_ = 0.0;  ///< turns commanded there, whichever way [rad]
  double net_ = 0.0;     ///< what came of them [rad]
  mrpt::math::TPose2D last_;
  double stalled_for_ = 0.0;
  double stood_for_ = 0.0;  ///< the wheels [s]
};

}  // namespace rubble::explore
