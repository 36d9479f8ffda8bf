#pragma once

#include <cstdint>
#include <vector>

#include "arenas/arena.h"
#include "base/angle.h"
#include "base/rng.h"
#include "robot/measurements.h"
#include "sim/ray_walk.h"
#include "sim/world.h"

namespace rubble::sim {

/// A camera for appearance and one for heat, both looking ahead.
struct VictimSensorParameters {
  double height = 0.5;                      ///< above the floor [m]
  double field_of_view = deg_to_rad(60.0);  ///< full angle
  double range = 2.0;                       ///< [m]
  double open_side = deg_to_rad(75.0);      ///< seen from within so much of the box's facing
  double period = 0.5;                      ///< [s]
  double bearing_sigma = deg_to_rad(2.0);   ///< [rad]
  double range_sigma = 0.05;                ///< relative
  double miss = 0.1;                        ///< probability a look overlooks what is there
  double false_alarm = 0.002;               ///< probability a look reports what is not there
};

/// Reports victims in view. Line of sight is checked against the arena's faces.
class VictimSensor {
 public:
  VictimSensor(const std::vector<arenas::Victim>& victims, const VictimSensorParameters& parameters,
               std::uint64_t seed);

  /// One look at `state.stamp`.
  std::vector<robot::VictimCue> look(const WorldState& state, const RayWalk& walk);
  double period() const { return parameters_.period; }

 private:
  bool in_view(const arenas::Victim& victim, const WorldState& state, const RayWalk& walk) const;

  std::vector<arenas::Victim> victims_;
  VictimSensorParameters parameters_;
  Rng rng_;
};

}  // namespace rubble::sim
