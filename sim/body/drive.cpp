#include "sim/body/drive.h"

#include <algorithm>
#include <cmath>

#include "robot/hardware_units.h"
#include "sim/body/contacts.h"

namespace rubble::sim {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr int kMaxIterations = 40;    ///< a start against a wall takes about as many, steady driving two or three
constexpr double kConverged = 1e-4;   ///< largest impulse change that counts as none: 7 um/s of 14 kg [N s]
constexpr double kCreepSpeed = 0.02;  ///< below it the slip ratio is taken as if at this speed [m/s]

/// Heights of the four feet as the plane's mean slopes and the twist that is left.
struct Relief {
  double pitch, roll;  ///< rise per metre, front over rear and left over right
  double twist;        ///< the front-left, rear-right diagonal stands above the plane by it, the other below [m]
};

Relief relief_of(const std::array<Ground, 4>& g, const robot::RobotModel& model) {
  return {0.5 * (g[0].height + g[2].height - g[1].height - g[3].height) / model.wheelbase,
          0.5 * (g[0].height + g[1].height - g[2].height - g[3].height) / model.track,
          0.25 * (g[0].height - g[1].height - g[2].height + g[3].height)};
}

}  // namespace

std::array<TPoint2D, 4> wheel_feet(const robot::RobotModel& model) {
  const double x = 0.5 * model.wheelbase;
  const double y = 0.5 * model.track;
  return {TPoint2D{x, y}, TPoint2D{-x, y}, TPoint2D{x, -y}, TPoint2D{-x, -y}};
}

std::array<Ground, 4> ground_under(const Terrain& terrain, const robot::RobotModel& model, const TPose2D& pose) {
  const double c = std::cos(pose.phi);
  const double s = std::sin(pose.phi);
  const std::array<TPoint2D, 4> feet = wheel_feet(model);
  std::array<Ground, 4> ground;
  for (std::size_t i = 0; i < 4; ++i) {
    ground[i] = terrain.under_wheel({pose.x + c * feet[i].x - s * feet[i].y, pose.y + s * feet[i].x + c * feet[i].y});
  }
  return ground;
}

Drive::Drive(const robot::RobotModel& model, const DriveParameters& parameters)
    : model_(model),
      parameters_(parameters),
      inverse_rotating_mass_(1.0 / parameters.rotating_mass),
      yaw_inertia_(model.mass * (model.length * model.length + model.width * model.width) / 12.0) {}

/// Vertical load of each wheel [N]: a quarter each, shifted downhill by the height of the centre of mass, and shifted
/// to the diagonal that the uneven floor lifts, as far as the tyres give.
std::array<double, 4> Drive::loads(const std::array<Ground, 4>& ground) const {
  const double weight = model_.mass * robot::kGravity;
  const Relief relief = relief_of(ground, model_);
  const double to_rear = 0.5 * weight * parameters_.centre_of_mass * relief.pitch / model_.wheelbase;
  const double to_right = 0.5 * weight * parameters_.centre_of_mass * relief.roll / model_.track;
  const double diagonal = parameters_.tyre_stiffness * relief.twist;
  const std::array<double, 4> shift{-to_rear - to_right + diagonal, to_rear - to_right - diagonal,
                                    -to_rear + to_right - diagonal, to_rear + to_right + diagonal};
  std::array<double, 4> load{};
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    load[i] = std::max(0.0, 0.25 * weight + shift[i]);
    sum += load[i];
  }
  for (double& l : load) l *= weight / sum;
  return load;
}

/// Masses as the floor under the wheels lets them be pushed in the plan view.
Inertia Drive::inertia(const std::array<Ground, 4>& ground, const std::array<double, 4>& load) const {
  Inertia inertia;
  inertia.inverse_mass = 1.0 / model_.mass;
  inertia.inverse_moment = 1.0 / yaw_inertia_;
  const double weight = model_.mass * robot::kGravity;
  for (std::size_t i = 0; i < 4; ++i) {
    inertia.gradient.x += load[i] / weight * ground[i].gx;
    inertia.gradient.y += load[i] / weight * ground[i].gy;
  }
  inertia.plan_share = 1.0 / (1.0 + dot(inertia.gradient, inertia.gradient));
  return inertia;
}

/// `heading`: unit vector ahead; `arm`: from the base to the wheel's foot, in the arena's directions.
Wheel Drive::contact(std::size_t i, const Ground& ground, double load, const TPoint2D& arm, const TPoint2D& heading,
                     const Inertia& inertia, const Motion& motion, double dt) const {
  Wheel wheel;
  wheel.side = i < 2 ? 0 : 1;
  TPoint2D ahead = heading;
  TPoint2D left{-heading.y, heading.x};
  double normal = load;
  if (!ground.is_level()) {
    // Paths on the slope are longer than in the plan, and the floor carries only what presses on it.
    const double rise_ahead = ground.gx * heading.x + ground.gy * heading.y;
    const double rise_left = -ground.gx * heading.y + ground.gy * heading.x;
    ahead = ahead * std::sqrt(1.0 + rise_ahead * rise_ahead);
    left = left * std::sqrt(1.0 + rise_left * rise_left);
    normal = load / std::sqrt(1.0 + ground.gx * ground.gx + ground.gy * ground.gy);
  }
  wheel.forward = inertia.axis(ahead, arm);
  wheel.left = inertia.axis(left, arm);
  wheel.limit = ground.friction * normal * dt;
  if (ground.on_sheet && wheel.limit > 0.0) {
    const double speed = std::max({kCreepSpeed, std::abs(motion.rims[wheel.side]), std::sqrt(dot(motion.u, motion.u))});
    wheel.softness = parameters_.sheet_creep * speed / wheel.limit;
    wheel.ruck_limit = parameters_.sheet_resistance * normal * dt;
  }
  wheel.kxx = wheel.forward.give() + wheel.softness;
  wheel.kyy = wheel.left.give() + wheel.softness;
  wheel.kxy = dot(wheel.left.direction, wheel.forward.du) + wheel.left.arm * wheel.forward.dw;
  wheel.invert(motion.yielding[wheel.side]);
  return wheel;
}

/// A tyre touches the floor over an area, and while the robot turns its parts slide differently. To first order that
/// resists with friction x load x rho^2 x w / slip, rho^2 = (length^2 + width^2) / 12; at most as a patch that only
/// spins.
void Drive::set_drilling(const Motion& motion, const std::array<Wheel, 4>& wheels) {
  const double rho2 =
      (parameters_.patch_length * parameters_.patch_length + parameters_.patch_width * parameters_.patch_width) / 12.0;
  double viscosity = 0.0;
  drill_limit_ = 0.0;
  for (const Wheel& wheel : wheels) {
    const double slip_x = motion.rims[wheel.side] - motion.speed(wheel.forward);
    const double slip_y = motion.speed(wheel.left);
    viscosity += wheel.limit * rho2 / std::max(1e-3, std::sqrt(slip_x * slip_x + slip_y * slip_y));
    drill_limit_ += wheel.limit * std::sqrt(rho2);
  }
  drill_softness_ = viscosity > 0.0 ? 1.0 / viscosity : 0.0;
  drill_impulse_ = std::clamp(drill_impulse_, -drill_limit_, drill_limit_);
}

double Drive::drill(Motion& motion, const Inertia& inertia) {
  const double old = drill_impulse_;
  const double more = -(motion.w + drill_softness_ * old) / (inertia.inverse_moment + drill_softness_);
  drill_impulse_ = std::clamp(old + more, -drill_limit_, drill_limit_);
  motion.w += inertia.inverse_moment * (drill_impulse_ - old);
  return std::abs(drill_impulse_ - old);
}

/// Begins with the last step's impulses, cut to this step's limits.
void Drive::warm_start(Motion& motion, const std::array<Wheel, 4>& wheels) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Wheel& wheel = wheels[i];
    const double size2 = dot(wheel_impulse_[i], wheel_impulse_[i]);
    if (size2 > wheel.limit * wheel.limit) wheel_impulse_[i] = wheel_impulse_[i] * (wheel.limit / std::sqrt(size2));
    ruck_impulse_[i] = std::clamp(ruck_impulse_[i], -wheel.ruck_limit, wheel.ruck_limit);
    wheel.push(motion, wheel_impulse_[i].x, wheel_impulse_[i].y);
    motion.push(wheel.forward, ruck_impulse_[i]);
  }
}

/// The motors bring the rims to the demanded speeds against the pull of the floor, as far as their force goes. Rims
/// that are held do not give way to the wheels' impulses: solved so, motor and wheels agree in a few rounds, where in
/// turns each would push the other's work away.
double Drive::drive_rims(Motion& motion, std::array<Wheel, 4>& wheels, const SideDemand& demand, double motor_limit) {
  double change = 0.0;
  for (std::size_t k = 0; k < 2; ++k) {
    const double wanted = demand.relaxed ? 0.0 : (k == 0 ? demand.left : demand.right);
    const double needed = (wanted - sides_[k].speed) * parameters_.rotating_mass + motion.pull[k];
    const double next = std::clamp(needed, -motor_limit, motor_limit);
    const bool held = next == needed;
    motion.rims[k] = held ? wanted : sides_[k].speed + (next - motion.pull[k]) * inverse_rotating_mass_;
    const double yielding = held ? 0.0 : inverse_rotating_mass_;
    if (yielding != motion.yielding[k]) {
      motion.yielding[k] = yielding;
      for (Wheel& wheel : wheels) {
        if (wheel.side == k) wheel.invert(yielding);
      }
      change = std::max(change, std::abs(next - motor_impulse_[k]));
    }
    motor_impulse_[k] = next;  // of held rims it only follows the wheels, of others it is the limit
  }
  return change;
}

PlanVelocity Drive::step(const TPose2D& pose, const std::array<Ground, 4>& ground, const PlanVelocity& before,
                         const SideDemand& demand, const std::vector<Stop>& stops, double dt) {
  const TPoint2D heading{std::cos(pose.phi), std::sin(pose.phi)};
  const std::array<TPoint2D, 4> feet = wheel_feet(model_);
  const std::array<double, 4> load = loads(ground);
  const Inertia inertia = this->inertia(ground, load);
  Motion motion;
  motion.u = {before.x, before.y};
  motion.w = before.w;
  motion.rims = {sides_[0].speed, sides_[1].speed};
  std::array<Wheel, 4> wheels;
  for (std::size_t i = 0; i < 4; ++i) {
    const TPoint2D arm{heading.x * feet[i].x - heading.y * feet[i].y, heading.y * feet[i].x + heading.x * feet[i].y};
    wheels[i] = contact(i, ground[i], load[i], arm, heading, inertia, motion, dt);
    // Gravity: the wheel's normal force leans downhill; the four together pull along the slope of potential energy.
    if (!ground[i].is_level()) motion.push(inertia.axis({-ground[i].gx, -ground[i].gy}, arm), load[i] * dt);
  }
  const double motor_limit = (demand.relaxed ? parameters_.gear_friction : parameters_.side_force) * dt;
  warm_start(motion, wheels);
  drive_rims(motion, wheels, demand, motor_limit);
  set_drilling(motion, wheels);
  motion.w += inertia.inverse_moment * drill_impulse_;
  std::vector<Axis> stop_axes;
  for (const Stop& stop : stops) {
    stop_axes.push_back(inertia.axis(stop.normal, {stop.point.x - pose.x, stop.point.y - pose.y}));
  }
  std::vector<double> stop_impulse(stops.size(), 0.0);

  double before_change = 0.0;
  for (iterations_ = 1; iterations_ < kMaxIterations; ++iterations_) {
    double change = drive_rims(motion, wheels, demand, motor_limit);
    for (std::size_t i = 0; i < 4; ++i) {
      change = std::max(change, wheels[i].roll(motion, wheel_impulse_[i]));
      change = std::max(change, wheels[i].ruck(motion, ruck_impulse_[i]));
    }
    change = std::max(change, drill(motion, inertia));
    for (std::size_t k = 0; k < stop_axes.size(); ++k) {
      const double old = stop_impulse[k];
      stop_impulse[k] = std::max(0.0, old - motion.speed(stop_axes[k]) / stop_axes[k].give());
      motion.push(stop_axes[k], stop_impulse[k] - old);
      change = std::max(change, std::abs(stop_impulse[k] - old));
    }
    // Changes that shrink at least to a half each time: what is still to come is a geometric series.
    const bool shrinks = 2.0 * change < before_change;
    if (change < kConverged || (shrinks && change * change < 0.5 * kConverged * (before_change - change))) break;
    before_change = change;
  }

  for (std::size_t k = 0; k < 2; ++k) {
    sides_[k].speed = motion.rims[k];
    sides_[k].travel += motion.rims[k] * dt;
    sides_[k].saturated = !demand.relaxed && std::abs(motor_impulse_[k]) >= motor_limit;
  }
  return {motion.u.x, motion.u.y, motion.w};
}

}  // namespace rubble::sim
