#include "sim/drive.h"

#include <algorithm>
#include <cmath>

namespace rubble::sim {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kGravity = 9.80665;  ///< [m/s^2]
constexpr int kMaxIterations = 40;    ///< a start against a wall takes about as many, steady driving one or two
constexpr double kConverged = 1e-4;   ///< largest impulse change that counts as none: 7 um/s of 14 kg [N s]
constexpr double kCreepSpeed = 0.02;  ///< below it the slip ratio is taken as if at this speed [m/s]

double dot(const TPoint2D& a, const TPoint2D& b) { return a.x * b.x + a.y * b.y; }
double cross(const TPoint2D& a, const TPoint2D& b) { return a.x * b.y - a.y * b.x; }

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

/// A direction in which an impulse acts at a contact, and what a unit of it does to the body.
struct Drive::Axis {
  TPoint2D direction;  ///< plan direction, scaled by path length on the slope per plan length
  double arm = 0.0;    ///< cross(base to contact, direction)
  TPoint2D du;         ///< change of plan velocity per impulse
  double dw = 0.0;     ///< change of turn rate per impulse
};

/// The five speeds. On a slope a horizontal push also has to lift the body: with the mean gradient g the mass in the
/// plan is m (I + g g^T), its inverse (I - g g^T / (1 + |g|^2)) / m.
struct Drive::Motion {
  TPoint2D u;                  ///< plan velocity [m/s]
  double w = 0.0;              ///< [rad/s]
  std::array<double, 2> rims;  ///< left, right [m/s]
  double inverse_mass = 0.0;
  double inverse_inertia = 0.0;
  TPoint2D gradient;

  Axis axis(const TPoint2D& direction, const TPoint2D& arm) const {
    const double along = dot(gradient, direction) / (1.0 + dot(gradient, gradient));
    const double turn = cross(arm, direction);
    return {direction,
            turn,
            {inverse_mass * (direction.x - along * gradient.x), inverse_mass * (direction.y - along * gradient.y)},
            inverse_inertia * turn};
  }
  double speed(const Axis& a) const { return a.direction.x * u.x + a.direction.y * u.y + a.arm * w; }
  void push(const Axis& a, double impulse) {
    u.x += impulse * a.du.x;
    u.y += impulse * a.du.y;
    w += impulse * a.dw;
  }
};

/// A wheel's contact in this step.
struct Drive::Wheel {
  Axis forward, left;
  double ixx = 0.0, iyy = 0.0, ixy = 0.0;  ///< impulse per slip: the inverse of slip per impulse, softness included
  double step = 0.0;                       ///< impulse per slip in any direction that never overshoots
  double softness = 0.0;                   ///< slip a held impulse leaves: loose paper [m/s per N s]
  double limit = 0.0;                      ///< radius of the friction circle [N s]
  double ruck_limit = 0.0;                 ///< [N s]
  std::size_t side = 0;
};

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
  const double weight = model_.mass * kGravity;
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

Drive::Wheel Drive::contact(std::size_t i, const Ground& ground, double load, const TPoint2D& arm, double heading_cos,
                            double heading_sin, const Motion& motion, double dt) const {
  Wheel wheel;
  wheel.side = i < 2 ? 0 : 1;
  const double rise_forward = ground.gx * heading_cos + ground.gy * heading_sin;
  const double rise_left = -ground.gx * heading_sin + ground.gy * heading_cos;
  const double stretch_forward = std::sqrt(1.0 + rise_forward * rise_forward);
  const double stretch_left = std::sqrt(1.0 + rise_left * rise_left);
  wheel.forward = motion.axis({heading_cos * stretch_forward, heading_sin * stretch_forward}, arm);
  wheel.left = motion.axis({-heading_sin * stretch_left, heading_cos * stretch_left}, arm);
  const double normal = load / std::sqrt(1.0 + ground.gx * ground.gx + ground.gy * ground.gy);
  wheel.limit = ground.friction * normal * dt;
  if (ground.on_sheet && wheel.limit > 0.0) {
    const double speed = std::max({kCreepSpeed, std::abs(motion.rims[wheel.side]), std::sqrt(dot(motion.u, motion.u))});
    wheel.softness = parameters_.sheet_creep * speed / wheel.limit;
    wheel.ruck_limit = parameters_.sheet_resistance * normal * dt;
  }
  const Axis& f = wheel.forward;
  const Axis& l = wheel.left;
  const double kxx = dot(f.direction, f.du) + f.arm * f.dw + inverse_rotating_mass_ + wheel.softness;
  const double kyy = dot(l.direction, l.du) + l.arm * l.dw + wheel.softness;
  const double kxy = dot(l.direction, f.du) + l.arm * f.dw;
  const double inverse = 1.0 / (kxx * kyy - kxy * kxy);
  wheel.ixx = kyy * inverse;
  wheel.iyy = kxx * inverse;
  wheel.ixy = -kxy * inverse;
  wheel.step = 1.0 / std::max(kxx, kyy);
  return wheel;
}

void Drive::push(Motion& motion, const Wheel& wheel, double along, double across) const {
  motion.push(wheel.forward, along);
  motion.push(wheel.left, across);
  motion.rims[wheel.side] -= along * inverse_rotating_mass_;
}

/// One projection of a wheel's impulse onto its friction circle; returns the largest change.
double Drive::roll(Motion& motion, const Wheel& wheel, TPoint2D& impulse) const {
  const double slip_x = motion.rims[wheel.side] - motion.speed(wheel.forward) - wheel.softness * impulse.x;
  const double slip_y = -motion.speed(wheel.left) - wheel.softness * impulse.y;
  TPoint2D next{impulse.x + wheel.ixx * slip_x + wheel.ixy * slip_y,
                impulse.y + wheel.iyy * slip_y + wheel.ixy * slip_x};
  if (dot(next, next) > wheel.limit * wheel.limit) {
    // Sliding: the projection must step equally in both directions, or friction would not oppose the slip.
    next = {impulse.x + wheel.step * slip_x, impulse.y + wheel.step * slip_y};
    const double size2 = dot(next, next);
    if (size2 > wheel.limit * wheel.limit) {
      const double cut = wheel.limit / std::sqrt(size2);
      next.x *= cut;
      next.y *= cut;
    }
  }
  const TPoint2D more{next.x - impulse.x, next.y - impulse.y};
  push(motion, wheel, more.x, more.y);
  impulse = next;
  return std::max(std::abs(more.x), std::abs(more.y));
}

/// Loose paper rucks up before a wheel and resists its way, whatever the wheel turns.
double Drive::ruck(Motion& motion, const Wheel& wheel, double& impulse) const {
  if (wheel.ruck_limit == 0.0) return 0.0;
  const Axis& f = wheel.forward;
  const double old = impulse;
  impulse =
      std::clamp(old - motion.speed(f) / (dot(f.direction, f.du) + f.arm * f.dw), -wheel.ruck_limit, wheel.ruck_limit);
  motion.push(f, impulse - old);
  return std::abs(impulse - old);
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

double Drive::drill(Motion& motion) {
  const double old = drill_impulse_;
  const double more = -(motion.w + drill_softness_ * old) / (motion.inverse_inertia + drill_softness_);
  drill_impulse_ = std::clamp(old + more, -drill_limit_, drill_limit_);
  motion.w += motion.inverse_inertia * (drill_impulse_ - old);
  return std::abs(drill_impulse_ - old);
}

Drive::Motion Drive::start(const std::array<Ground, 4>& ground, const std::array<double, 4>& load,
                           const PlanVelocity& before) const {
  Motion motion;
  motion.u = {before.x, before.y};
  motion.w = before.w;
  motion.rims = {sides_[0].speed, sides_[1].speed};
  motion.inverse_mass = 1.0 / model_.mass;
  motion.inverse_inertia = 1.0 / yaw_inertia_;
  const double weight = model_.mass * kGravity;
  for (std::size_t i = 0; i < 4; ++i) {
    motion.gradient.x += load[i] / weight * ground[i].gx;
    motion.gradient.y += load[i] / weight * ground[i].gy;
  }
  return motion;
}

/// Begins with the last step's impulses, cut to this step's limits.
void Drive::warm_start(Motion& motion, const std::array<Wheel, 4>& wheels, double motor_limit) {
  for (std::size_t i = 0; i < 4; ++i) {
    const double size2 = dot(wheel_impulse_[i], wheel_impulse_[i]);
    const double limit = wheels[i].limit;
    if (size2 > limit * limit) wheel_impulse_[i] = wheel_impulse_[i] * (limit / std::sqrt(size2));
    ruck_impulse_[i] = std::clamp(ruck_impulse_[i], -wheels[i].ruck_limit, wheels[i].ruck_limit);
    push(motion, wheels[i], wheel_impulse_[i].x, wheel_impulse_[i].y);
    motion.push(wheels[i].forward, ruck_impulse_[i]);
  }
  set_drilling(motion, wheels);
  motion.w += motion.inverse_inertia * drill_impulse_;
  for (std::size_t k = 0; k < 2; ++k) {
    motor_impulse_[k] = std::clamp(motor_impulse_[k], -motor_limit, motor_limit);
    motion.rims[k] += motor_impulse_[k] * inverse_rotating_mass_;
  }
}

/// The motors bring the rims to the demanded speeds as far as their force goes.
double Drive::drive_rims(Motion& motion, const SideDemand& demand, double motor_limit) {
  double change = 0.0;
  for (std::size_t k = 0; k < 2; ++k) {
    const double wanted = demand.relaxed ? 0.0 : (k == 0 ? demand.left : demand.right);
    const double old = motor_impulse_[k];
    motor_impulse_[k] =
        std::clamp(old + (wanted - motion.rims[k]) * parameters_.rotating_mass, -motor_limit, motor_limit);
    motion.rims[k] += (motor_impulse_[k] - old) * inverse_rotating_mass_;
    change = std::max(change, std::abs(motor_impulse_[k] - old));
  }
  return change;
}

PlanVelocity Drive::step(const TPose2D& pose, const std::array<Ground, 4>& ground, const PlanVelocity& before,
                         const SideDemand& demand, const std::vector<Stop>& stops, double dt) {
  const double c = std::cos(pose.phi);
  const double s = std::sin(pose.phi);
  const std::array<TPoint2D, 4> feet = wheel_feet(model_);
  const std::array<double, 4> load = loads(ground);
  Motion motion = start(ground, load, before);
  std::array<Wheel, 4> wheels;
  for (std::size_t i = 0; i < 4; ++i) {
    const TPoint2D arm{c * feet[i].x - s * feet[i].y, s * feet[i].x + c * feet[i].y};
    wheels[i] = contact(i, ground[i], load[i], arm, c, s, motion, dt);
    // Gravity: the wheel's normal force leans downhill; the four together pull along the slope of potential energy.
    motion.push(motion.axis({-ground[i].gx, -ground[i].gy}, arm), load[i] * dt);
  }
  const double motor_limit = (demand.relaxed ? parameters_.gear_friction : parameters_.side_force) * dt;
  warm_start(motion, wheels, motor_limit);
  std::vector<Axis> stop_axes;
  for (const Stop& stop : stops) {
    stop_axes.push_back(motion.axis(stop.normal, {stop.point.x - pose.x, stop.point.y - pose.y}));
  }
  std::vector<double> stop_impulse(stops.size(), 0.0);

  for (iterations_ = 1; iterations_ < kMaxIterations; ++iterations_) {
    double change = drive_rims(motion, demand, motor_limit);
    for (std::size_t i = 0; i < 4; ++i) {
      change = std::max(change, roll(motion, wheels[i], wheel_impulse_[i]));
      change = std::max(change, ruck(motion, wheels[i], ruck_impulse_[i]));
    }
    change = std::max(change, drill(motion));
    for (std::size_t k = 0; k < stop_axes.size(); ++k) {
      const Axis& axis = stop_axes[k];
      const double old = stop_impulse[k];
      stop_impulse[k] = std::max(0.0, old - motion.speed(axis) / (dot(axis.direction, axis.du) + axis.arm * axis.dw));
      motion.push(axis, stop_impulse[k] - old);
      change = std::max(change, std::abs(stop_impulse[k] - old));
    }
    if (change < kConverged) break;
  }

  for (std::size_t k = 0; k < 2; ++k) {
    sides_[k].speed = motion.rims[k];
    sides_[k].travel += motion.rims[k] * dt;
    sides_[k].saturated = !demand.relaxed && std::abs(motor_impulse_[k]) >= motor_limit;
  }
  return {motion.u.x, motion.u.y, motion.w};
}

}  // namespace rubble::sim
