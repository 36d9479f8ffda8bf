#pragma once

#include <Eigen/Core>
#include <vector>

#include "robot/model.h"
#include "sim/body/attitude.h"
#include "sim/body/world_state.h"

namespace rubble::sim {

/// A line of sight. `direction` has unit length.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

/// Where something is mounted in the arena frame.
struct Placement {
  Eigen::Matrix3d R;
  Eigen::Vector3d p;
};

/// Rotation about z by yaw, then nose up by pitch, then left side up by roll.
Eigen::Matrix3d rotation(double yaw, double pitch, double roll);

/// T_arena_base.
Placement base_placement(const WorldState& state);
/// T_base_laser with the servos at zero.
struct LaserMount {
  explicit LaserMount(const robot::RobotModel& model);
  Eigen::Vector3d p;
  Eigen::Matrix3d R;
};

/// T_arena_laser: the platform turns about the laser's origin, first in pitch, then in roll.
Placement laser_placement(const WorldState& state, const LaserMount& mount);
Placement laser_placement(const WorldState& state, const robot::RobotModel& model);

/// T_arena_laser at `stamp`, between the two states around it (the last state's beyond it).
Placement laser_placement_at(const std::vector<WorldState>& states, const robot::RobotModel& model, Stamp stamp);

/// Whether laser and robot stood still (to 0.1 mm and 0.001 deg) from `from` to `to`.
bool at_rest(const std::vector<WorldState>& states, Stamp from, Stamp to);

/// The rays of one sweep, each from the laser's placement at its own time, about `middle` so that floats keep
/// micrometres. Structure of arrays, padded to whole groups of four.
struct Beams {
  std::size_t count = 0;
  Placement middle;               ///< of the laser, half way through the sweep
  double travel = 0.0;            ///< how far an origin is from middle.p at most [m]
  double lift = 0.0;              ///< the part of it along the laser's axis [m]
  double turn = 0.0;              ///< about the laser's axis, against middle.R, at most [rad]
  double tilt = 0.0;              ///< of the laser's axis against the middle one's, at most [rad]
  std::vector<float> ox, oy, oz;  ///< origin minus middle.p [m]
  std::vector<float> dx, dy, dz;  ///< unit direction

  Ray ray(std::size_t beam) const;
};

/// The laser's bearings, computed once: beam directions in the laser frame. Padded to whole groups of four.
struct BeamTable {
  explicit BeamTable(const robot::LaserModel& laser);
  std::size_t count = 0;
  double angle_min = 0.0;
  double angle_step = 0.0;
  double beams_per_radian = 0.0;
  std::vector<float> cosine, sine;
};

/// The rays of a scan whose beam i leaves at first + i * beam_period. `states` cover that time, sorted by stamp;
/// between two states position and axes are interpolated linearly (0.15 mm at 4 m for 100 deg/s and 10 ms steps).
void swept_beams(const std::vector<WorldState>& states, const robot::RobotModel& model, const BeamTable& table,
                 Stamp first, double beam_period, Beams& beams);

}  // namespace rubble::sim
