#pragma once

#include <array>

#include "robot/model.h"
#include "sim/body/terrain.h"

namespace rubble::sim {

/// How the base stands on the floor.
struct Stance {
  double z = 0.0;      ///< of the base origin [m]
  double pitch = 0.0;  ///< nose-up positive [rad]
  double roll = 0.0;   ///< left side up positive [rad]
};

/// The least-squares plane through the heights under the four wheels (front-left, rear-left, front-right, rear-right).
/// On a plane floor it is that plane; where the floor is twisted the tyres take up the rest equally.
Stance stance_on(const std::array<Ground, 4>& ground, const robot::RobotModel& model);

/// The stance over time: first-order low pass of 30 ms, the give of the pneumatic tyres, so that edges are not felt as
/// jumps.
class Attitude {
 public:
  explicit Attitude(const Stance& start) : stance_(start) {}
  void step(const Stance& resting, double dt);
  const Stance& stance() const { return stance_; }

 private:
  Stance stance_;
};

}  // namespace rubble::sim
