#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <array>
#include <vector>

#include "robot/model.h"
#include "sim/body/terrain.h"

namespace rubble::sim {

struct Inertia;
struct Motion;
struct Wheel;

/// What the data sheets leave open about a Pioneer 3-AT's running gear; docs/simulator.md gives the reasons.
struct DriveParameters {
  double centre_of_mass = 0.18;    ///< height above the wheels' feet [m]
  double side_force = 50.0;        ///< what the motor of one side can push at the wheel rim [N]
  double gear_friction = 10.0;     ///< holds a side whose motor is relaxed [N]
  double rotating_mass = 2.0;      ///< wheels, belt, gears and rotor of one side, at the rim [kg]
  double tyre_stiffness = 15e3;    ///< of one tyre against the floor [N/m]
  double patch_length = 0.08;      ///< what of a soft tyre touches the floor [m]
  double patch_width = 0.05;       ///< [m]
  double sheet_creep = 0.4;        ///< slip ratio of a wheel on loose paper when it starts to slide
  double sheet_resistance = 0.07;  ///< loose paper rucks up before a wheel: force over load
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
  explicit Drive(const robot::RobotModel& model, const DriveParameters& parameters = {});

  /// The plan velocity after `dt`, before anything but `stops` pushes back. `ground`: under the four wheels at `pose`.
  PlanVelocity step(const mrpt::math::TPose2D& pose, const std::array<Ground, 4>& ground, const PlanVelocity& before,
                    const SideDemand& demand, const std::vector<Stop>& stops, double dt);

  const Side& left() const { return sides_[0]; }
  const Side& right() const { return sides_[1]; }
  double yaw_inertia() const { return yaw_inertia_; }
  /// Of the last step.
  int iterations() const { return iterations_; }

 private:
  std::array<double, 4> loads(const std::array<Ground, 4>& ground) const;
  Inertia inertia(const std::array<Ground, 4>& ground, const std::array<double, 4>& load) const;
  Wheel contact(std::size_t i, const Ground& ground, double load, const mrpt::math::TPoint2D& arm,
                const mrpt::math::TPoint2D& heading, const Inertia& inertia, const Motion& motion, double dt) const;
  void warm_start(Motion& motion, const std::array<Wheel, 4>& wheels);
  double drive_rims(Motion& motion, std::array<Wheel, 4>& wheels, const SideDemand& demand, double motor_limit);
  void set_drilling(const Motion& motion, const std::array<Wheel, 4>& wheels);
  double drill(Motion& motion, const Inertia& inertia);

  robot::RobotModel model_;
  DriveParameters parameters_;
  double inverse_rotating_mass_;  ///< [1/kg]
  double yaw_inertia_;
  int iterations_ = 0;
  std::array<Side, 2> sides_;
  // Impulses of the last step: the first guess of the next.
  std::array<mrpt::math::TPoint2D, 4> wheel_impulse_{};  ///< along, across [N s]
  std::array<double, 4> ruck_impulse_{};
  std::array<double, 2> motor_impulse_{};
  double drill_impulse_ = 0.0;   ///< about the vertical [N m s]
  double drill_softness_ = 0.0;  ///< turn rate per impulse [rad/s per N m s]
  double drill_limit_ = 0.0;     ///< [N m s]
};

/// The ground under front-left, rear-left, front-right and rear-right wheel.
std::array<Ground, 4> ground_under(const Terrain& terrain, const robot::RobotModel& model,
                                   const mrpt::math::TPose2D& pose);

/// Where the four wheels stand in the base frame: front-left, rear-left, front-right, rear-right [m].
std::array<mrpt::math::TPoint2D, 4> wheel_feet(const robot::RobotModel& model);

}  // namespace rubble::sim
