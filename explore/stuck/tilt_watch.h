#pragma once

#include "base/angle.h"
#include "robot/measurements.h"
#include "robot/tilt.h"

namespace rubble::explore {

struct TiltWatchConfig {
  double too_steep = deg_to_rad(18.0);  ///< more than the ramps of an arena: a step field, or a fall to come [rad]
  double patience = 0.3;                ///< for so long [s]
  double silence = 1.0;                 ///< after so long without angles the servos are taken to be out of order [s]
  double smoothing = 0.2;               ///< time constant: levelling answers to bumps as well [s]
};

/// How the body leans. The servos hold the laser level, so their angles are the body's tilt, negated.
class TiltWatch {
 public:
  explicit TiltWatch(const TiltWatchConfig& config = {}) : config_(config) {}

  /// Takes in the servo angles of one tick of `dt` [s].
  void update(const robot::Inputs& inputs, double dt);
  const robot::Tilt& lean() const { return lean_; }
  /// Of the ground below the robot against the horizontal [rad].
  double slope() const;
  /// The robot leans more than it should, and has for a while.
  bool too_steep() const { return steep_for_ > config_.patience; }
  /// The servos jammed: from now on their angles say nothing.
  void distrust() { distrusted_ = true; }
  void reset() { steep_for_ = 0.0; }

 private:
  TiltWatchConfig config_;
  robot::Tilt lean_;
  double steep_for_ = 0.0;   ///< [s]
  double silent_for_ = 0.0;  ///< [s]
  bool distrusted_ = false;
};

}  // namespace rubble::explore
