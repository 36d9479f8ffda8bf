#pragma once

#include <mrpt/math/TPose2D.h>

#include "base/stamp.h"
#include "robot/commands.h"
#include "sim/body/attitude.h"
#include "sim/body/drive.h"

// What sensors see of the physical world: where the robot is, and what moves about it.

namespace rubble::sim {

/// Where everything of the robot is at one instant.
struct WorldState {
  Stamp stamp;
  mrpt::math::TPose2D pose;  ///< of the base in the arena, plan view
  Stance stance;
  robot::LaserAim aim;  ///< true servo angles
  PlanVelocity velocity;
};

/// A ball as the laser sees it.
struct Sphere {
  double x = 0.0, y = 0.0, z = 0.0;  ///< centre [m]
  double radius = 0.0;               ///< [m]
};

/// An upright cylinder as the laser sees it: bottle, radio.
struct Cylinder {
  double x = 0.0, y = 0.0;            ///< axis [m]
  double bottom = 0.0, height = 0.0;  ///< [m]
  double radius = 0.0;                ///< [m]
};

}  // namespace rubble::sim
