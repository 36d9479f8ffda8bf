#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <array>
#include <vector>

#include "robot/model.h"
#include "sim/terrain.h"

namespace rubble::sim {

/// What the data sheets leave open about a Pioneer 3-AT's running gear; docs/simulator.md gives the reasons.
struct DriveParameters {
  double centre_of_mass = 0.18;   ///< height above the wheels' feet [m]
  double side_force = 50.0;       ///< what the motor of one side can push at the wheel rim [N]
  double gear_friction = 10.0;    ///< holds a side whose motor is relaxed [N]
  double rotating_mass = 2.0;     ///< wheels, belt, gears and rotor of one side, at the rim [kg]
  double tyre_stiffness = 15e3;   ///< of one tyre against the floor [N/m]
  double sheet_creep = 0.25;      ///< slip ratio of a wheel on loose paper when it starts to slide
  double sheet_resistance = 0.1;  ///< loose paper rucks up before a wheel: force over load
};

/// Motion in the plan view.
struct PlanVelocity {
  double x = 0.0;  ///< [m/s]
  double y = 0.0;  ///< [m/s]
  double w = 0.0;  ///< counter-clockwise [rad/s]
};

/// Something the body touches and cannot push away: it may only move along `normal` there.
struct Stop {
  mrpt::math::TPoint2D point;   ///< [m]
  mrpt::math::TPoint2D normal;  ///< unit vector into the body
};

/// What the two motor controllers want.
struct SideDemand {
  double left = 0.0;     ///< rim speed [m/s]
  double right = 0.0;    ///< rim speed [m/s]
  bool relaxed = false;  ///< motors off: only the gears hold
};

/// One side's two wheels, joined by a belt.
struct Side {
  double speed = 0.0;      ///< of the rims [m/s]
  double travel = 0.0;     ///< of the rims since the start: what the encoder counts [m]
  bool saturated = false;  ///< the motor pushes with all it has
};

/// Skid steering: four wheel contacts with a friction circle each, solved together with the two motors as impulses.
///
/// Unknowns are the plan velocity (x, y, w) and the rim speeds of the two sides. A wheel's slip along and across its
/// direction of travel, in the slope under it, drives an impulse of at most friction x load x dt. Projected
/// Gauss-Seidel with warm start (Moreau 1988, Catto 2005); the disc projection makes sliding friction point against
/// the slip, which is what makes a skid-steered robot turn less than its wheels say.
class Drive {
 public:
  Drive(const Terrain& terrain, const robot::RobotModel& model, const DriveParameters& parameters = {});

  /// The plan velocity after `dt`, before anything but `stops` pushes back.
  PlanVelocity step(const mrpt::math::TPose2D& pose, const PlanVelocity& before, const SideDemand& demand,
                    const std::vector<Stop>& stops, double dt);

  const Side& left() const { return sides_[0]; }
  const Side& right() const { return sides_[1]; }
  double yaw_inertia() const { return yaw_inertia_; }
  /// The ground under front-left, rear-left, front-right, rear-right wheel at the last step.
  const std::array<Ground, 4>& ground() const { return ground_; }

 private:
  struct Wheel;
  struct Motion;

  std::array<double, 4> loads() const;

  const Terrain& terrain_;
  robot::RobotModel model_;
  DriveParameters parameters_;
  double yaw_inertia_;
  std::array<Side, 2> sides_;
  std::array<Ground, 4> ground_;
  std::array<double, 4> forward_impulse_{};  ///< of the last step: the first guess of the next
  std::array<double, 4> lateral_impulse_{};
  std::array<double, 4> ruck_impulse_{};
  std::array<double, 2> motor_impulse_{};
};

/// Where the four wheels stand in the base frame: front-left, rear-left, front-right, rear-right [m].
std::array<mrpt::math::TPoint2D, 4> wheel_feet(const robot::RobotModel& model);

}  // namespace rubble::sim
