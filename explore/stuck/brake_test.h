#pragma once

#include "base/stamp.h"
#include "explore/stuck/rest.h"
#include "robot/measurements.h"

namespace rubble::explore {

struct BrakeTestConfig {
  /// Of the test: a base that brakes stands after 0.1 s; what the levelling makes of it comes later [s].
  double time = 0.15;
  double share = 0.5;     ///< of the speed of its wheels: a body that lost as much was moving
  double slowest = 0.2;   ///< slower wheels are not asked: what the body loses is not told from noise and slopes [m/s]
  double settling = 0.5;  ///< time constant of what counts as rest: a slope's or the levelling's share of gravity [s]
};

/// Asks a robot whose pose stays whether it moves: it brakes, and the accelerometer feels a body that was moving lose
/// its speed. One that stood before its spinning wheels feels nothing, but for a levelling unit that takes the stop of
/// the wheels for one of the body and tilts, a tenth of a second later and softly. Between bare walls the scans may
/// hold on to the floor of a slope, whose line they meet elsewhere with each degree of tilt, and the pose falls behind
/// a robot that drives as told. A base that cannot stop at once, but runs down its ramp, loses too little in the time
/// of the test and counts as one that stood: its pose is believed.
class BrakeTest {
 public:
  enum class Verdict { Open, Moved, Stood };

  explicit BrakeTest(const BrakeTestConfig& config = {}) : config_(config), rest_(config.settling) {}

  /// Takes in what was felt in one tick.
  void update(const robot::Inputs& inputs);
  /// Whether wheels at this `speed` [m/s] can be asked: they are fast enough, and an accelerometer is heard.
  bool can_tell(double speed, Stamp now) const;
  /// From now on it brakes; `speed`: of its wheels before [m/s].
  void begin(double speed, Stamp now);
  /// Open before a test has begun.
  Verdict verdict(Stamp now) const;
  /// How much of the speed of its wheels the body has lost; what stood loses none but for noise.
  double lost_share() const;

 private:
  bool under_way(Stamp stamp) const;

  BrakeTestConfig config_;
  Rest rest_;            ///< kept as it was while a test is under way
  double speed_ = 0.0;   ///< of the wheels when the test began [m/s]
  double gained_ = 0.0;  ///< by the body since then [m/s]
  Stamp begun_ = Stamp::never();
};

}  // namespace rubble::explore
