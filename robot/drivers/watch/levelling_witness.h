#pragma once

#include <string>

#include "robot/measurements.h"

namespace rubble::robot {

/// Holds what the servos do against what the accelerometer on their platform feels: a platform that is aimed far one
/// way to take a tilt away, and feels that very tilt all the while, is turned the wrong way, or not at all.
class LevellingWitness {
 public:
  /// What the unit felt and where its servos stood, as they come.
  void look(const Acceleration& felt, const AimState& aim);

  /// What is wrong, in words; empty: nothing. Stays.
  const std::string& finding() const { return finding_; }

 private:
  struct Axis {
    const char* name;
    double tilt = 0.0;         ///< felt, without its quick part [rad]
    double tilt_before = 0.0;  ///< when the servo stood near its middle last [rad]
    Stamp since = Stamp::never();
  };
  void look(Axis& axis, double tilt, double aim, double dt, Stamp now);

  Axis pitch_{"pitch"}, roll_{"roll"};
  Stamp last_ = Stamp::never();
  std::string finding_;
};

}  // namespace rubble::robot
