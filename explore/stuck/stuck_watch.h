#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <string>

#include "base/stamp.h"
#include "explore/stuck/brake_test.h"
#include "explore/stuck/escape.h"
#include "explore/stuck/jolt_watch.h"
#include "explore/stuck/motion_watch.h"
#include "explore/stuck/slowed_watch.h"
#include "explore/stuck/tilt_watch.h"
#include "robot/commands.h"
#include "robot/measurements.h"

namespace rubble::explore {

/// Finds out that something holds the robot which the scanner cannot see: it leans, a blow stops it or holds it back,
/// its motors stall, or it does not move as told. Not so while nobody knows whether it moves: the base is silent, or
/// the robot was held for a while (a device was away) and its motors may still be off.
class StuckWatch {
 public:
  struct Hold {
    std::string how;  ///< for people
    Escape::Met met;
    bool stands = false;          ///< no more is known than that it does not move as told
    bool steers_in_vain = false;  ///< no more than that its wheels turn it and its heading stays
  };

  explicit StuckWatch(const TiltWatchConfig& tilt) : tilt_(tilt) {}

  /// Takes in what arrived in a tick, `passed` [s] after the tick before; `dt` [s] of it the robot followed its
  /// command.
  void update(const robot::Inputs& inputs, double passed, double dt);
  /// Judges the tick under the command that was in force. `on_purpose`: it may turn in its place. Once told, a hold is
  /// forgotten.
  std::optional<Hold> held(const mrpt::math::TPose2D& T_map_base, const robot::Drive& commanded, bool on_purpose,
                           double dt, Stamp now);
  /// The robot stands by its own will, or has got free: its motion is watched anew.
  void begin_anew() {
    motion_.reset();
    slowed_.reset();
  }

  /// The robot brakes as hard as it can: what stops it is no blow.
  void braked(Stamp now) { jolt_.braked(now); }

  /// Nothing but its pose says that it is held, and braking can tell whether that is so.
  bool brake_can_tell(const Hold& hold, Stamp now) const {
    return hold.stands && hold.met != Escape::Met::Turning && wheels_ && brake_test_.can_tell(wheels_->v, now);
  }
  /// From now on the robot brakes as hard as it can, until there is a verdict.
  void begin_brake_test(Stamp now) { brake_test_.begin(wheels_->v, now); }
  BrakeTest::Verdict brake_verdict(Stamp now) const { return brake_test_.verdict(now); }
  /// How much of its speed it felt itself lose in the test.
  double lost_by_braking() const { return brake_test_.lost_share(); }
  /// It moved: its pose falls behind. For a while that alone is no sign of being held.
  void doubt_pose(Stamp now);

  /// The servos jammed: how the robot leans is no longer known.
  void distrust_tilt() { tilt_.distrust(); }

  const robot::Tilt& lean() const { return tilt_.lean(); }
  /// The motors report a stall.
  bool stalled() const { return stalled_; }
  /// What the wheels do, where that is known.
  const std::optional<robot::Drive>& wheels() const { return wheels_; }
  /// A blow stopped the body in this tick.
  bool struck() const { return jolt_.struck(); }
  /// One did that may have been the edge of a ramp as well.
  bool shaken() const { return jolt_.shaken(); }

 private:
  Escape::Met met(const robot::Drive& commanded) const;

  MotionWatch motion_;
  TiltWatch tilt_;
  JoltWatch jolt_;
  SlowedWatch slowed_;
  BrakeTest brake_test_;
  bool stalled_ = false;
  std::optional<robot::Drive> wheels_;    ///< what they did when they were heard of last
  std::optional<Stamp> odometry_at_;      ///< when the wheels were heard of last
  Stamp patient_until_ = Stamp::never();  ///< the base may not obey yet
  Stamp pose_doubted_until_ = Stamp::never();
};

}  // namespace rubble::explore
