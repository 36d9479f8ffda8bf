#pragma once

#include <optional>

#include "base/angle.h"
#include "robot/felt_tilt.h"
#include "robot/measurements.h"
#include "robot/model.h"

namespace rubble::robot {

/// What can be said of the levelling unit.
enum class LevellingState {
  Works,   ///< or there never was one
  Silent,  ///< its angles, or what its accelerometer feels, came once and no longer come; both again: it works
  Jammed   ///< its servos do not turn, whatever their pulses say; for good
};

/// Holds what the servos are told against what the accelerometer on their platform feels, and notices when one of them
/// says no more.
class LevellingWatch {
 public:
  explicit LevellingWatch(const RobotModel& model);

  /// Takes in what arrived in a tick.
  void update(const Inputs& inputs);
  LevellingState state() const { return state_; }
  /// It works, and the platform feels level, where it can: its servos' angles, negated, are how the body leans. Those
  /// of servos that turn in vain grow long before they are known to.
  bool level() const;
  /// Where servos that jammed stand: where their platform felt level last. Nothing while they do not.
  const std::optional<LaserAim>& jammed_at() const { return jammed_at_; }

 private:
  struct Axis {
    double tilt = 0.0;       ///< felt, without its quick part [rad]
    double level_for = 0.0;  ///< so long that has been small [s]
    double leans_for = 0.0;  ///< so long it has been level, aimed farther than robots lean [s]
    double level_aim = 0.0;  ///< when that was last [rad]
    Stamp in_vain_since = Stamp::never();
    double in_vain_tilt = 0.0;  ///< without its sign, then [rad]
  };
  void feel(const Acceleration& acceleration);
  bool turns_in_vain(Axis& axis, double tilt, double aim, double dt, Stamp now) const;

  const bool on_platform_;
  const double stop_;  ///< aimed so far the servos are at the end of their travel [rad]
  FeltTilt felt_;
  Axis pitch_, roll_;
  std::optional<LaserAim> aim_;
  Stamp last_aim_ = Stamp::never();   ///< when it came
  Stamp last_felt_ = Stamp::never();  ///< when it came
  Stamp last_sample_ = Stamp::never();
  LevellingState state_ = LevellingState::Works;
  std::optional<LaserAim> jammed_at_;
};

}  // namespace rubble::robot
