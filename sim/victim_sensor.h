#pragma once

#include <mrpt/math/TPoint3D.h>

#include <cstdint>
#include <vector>

#include "arenas/model/arena.h"
#include "base/angle.h"
#include "base/rng.h"
#include "robot/measurements.h"
#include "sim/body/world_state.h"
#include "sim/laser/ray_walk.h"

namespace rubble::sim {

/// One sense for victims. The figures are assumptions; docs/simulator.md gives the reasons.
struct CueSense {
  robot::CueKind kind = robot::CueKind::Appearance;
  bool fitted = true;
  double field_of_view = deg_to_rad(60.0);  ///< full angle about the front
  double range = 2.0;                       ///< with a free line of sight [m]
  double muffled_range = 0.0;               ///< through walls and boxes [m]
  double open_side = deg_to_rad(75.0);      ///< from within so much of the box's facing
  double bearing_sigma = deg_to_rad(2.0);   ///< [rad]
  double range_sigma = 0.05;                ///< relative
  double miss = 0.1;                        ///< probability a look overlooks what is there
  double false_alarm = 0.002;               ///< probability a look reports what is not there
  double surest = 1.0;  ///< confidence of a true cue: 0.6 to 1 times this; of a false one 0.3 to 0.7
};

struct VictimSensorParameters {
  double height = 0.5;  ///< of the sensors above the floor [m]
  double period = 0.5;  ///< between two looks [s]
  CueSense appearance{robot::CueKind::Appearance};
  CueSense heat{robot::CueKind::Heat};
  /// A pair of microphones: hears all round and round corners, and places badly.
  CueSense sound{robot::CueKind::Sound, false, 2.0 * kPi, 3.0, 1.5, kPi, deg_to_rad(15.0), 0.4, 0.3, 0.005, 0.3};
  /// A probe that smells what comes out of the box, close by.
  CueSense co2{robot::CueKind::Co2, false, kPi, 0.9, 0.0, deg_to_rad(75.0), deg_to_rad(30.0), 0.3, 0.2, 0.002, 0.5};
};

/// What a level robot can find in an arena, wherever it is turned to: with its cameras, or, of victims that no camera
/// finds, with the probe or the microphones.
class VictimView {
 public:
  explicit VictimView(const arenas::Arena& arena) : walk_(arenas::faces(arena)) {}
  double reach(const arenas::Victim& victim) const { return sense_for(victim).range; }  ///< [m]
  /// Of a robot that stands at `floor` [m]: in reach, on the open side of the box and on a line that no face cuts, as
  /// far as the sense needs that.
  bool find(const arenas::Victim& victim, const mrpt::math::TPoint3D& floor) const;

 private:
  const CueSense& sense_for(const arenas::Victim& victim) const;

  VictimSensorParameters sensors_;
  RayWalk walk_;
};

/// Reports what the senses take for victims. Lines of sight are checked against the arena's faces.
class VictimSensor {
 public:
  VictimSensor(const std::vector<arenas::Victim>& victims, const VictimSensorParameters& parameters,
               std::uint64_t seed);

  /// One look at `state.stamp`. `moving`: faces of other robots that may stand in between.
  std::vector<robot::VictimCue> look(const WorldState& state, const RayWalk& walk,
                                     const std::vector<arenas::Face>& moving = {});
  double period() const { return parameters_.period; }

 private:
  bool senses(const CueSense& sense, const arenas::Victim& victim, const WorldState& state) const;
  void look(const CueSense& sense, const WorldState& state, Rng& rng, std::vector<robot::VictimCue>& cues) const;

  std::vector<arenas::Victim> victims_;
  VictimSensorParameters parameters_;
  const RayWalk* walk_ = nullptr;    ///< of the look in progress
  const RayWalk* others_ = nullptr;  ///< the same for what moves, or null
  Rng cameras_;
  Rng sound_;
  Rng co2_;
};

}  // namespace rubble::sim
