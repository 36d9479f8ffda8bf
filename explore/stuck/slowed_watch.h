#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>

#include "base/angle.h"
#include "base/stamp.h"
#include "robot/commands.h"

namespace rubble::explore {

struct SlowedWatchConfig {
  double soonest = 0.25;           ///< after a weak blow it shows what the robot does [s]
  double latest = 0.5;             ///< later it has passed what it met [s]
  double moved = 0.7;              ///< of its wheels' way it comes at least so far where nothing holds it
  double aside = deg_to_rad(5.0);  ///< and turns otherwise than they do by no more than this [rad]
  double slip = 0.15;              ///< and this share of their turn
  double crest = deg_to_rad(5.0);  ///< where it leans otherwise by more than this it has passed a crest [rad]
  double least_way = 0.03;         ///< of the wheels that tells anything [m]
  double jump = 0.04;              ///< a pose that moves more from tick to tick, beside its way, is corrected [m]
  double scan_time = 0.1;          ///< that way is what the wheels make in so long [s]
};

/// Finds out what a weak blow was. Where a corner of the body meets a step the blow takes a part of its speed only, as
/// the edge of a ramp does that it climbs: but then it falls behind its wheels, or is turned aside. Over a crest it may
/// seem to fall behind, for its scans are not level meanwhile; the servos' angles tell it, so with a laser that is
/// fixed to the robot a crest may be taken for a step.
class SlowedWatch {
 public:
  explicit SlowedWatch(const SlowedWatchConfig& config = {}) : config_(config) {}

  /// One tick of `dt` [s] in which a weak blow was felt, or none. `wheels`: what they do; `pitch`: the body's [rad].
  /// True when something that was met in the last half second holds the robot.
  bool held(bool shaken, const mrpt::math::TPose2D& T_map_base, const robot::Drive& wheels, double pitch, double dt,
            Stamp now);
  void reset() { since_.reset(); }

 private:
  struct Since {
    Stamp at;
    mrpt::math::TPose2D T_map_base;
    double pitch = 0.0;
    double way = 0.0;   ///< of the wheels [m]
    double turn = 0.0;  ///< [rad]
  };

  SlowedWatchConfig config_;
  std::optional<Since> since_;  ///< the blow
  mrpt::math::TPose2D last_;
};

}  // namespace rubble::explore
