#include "sim/drive.h"

#include <algorithm>
#include <cmath>

namespace rubble::sim {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kGravity = 9.80665;  ///< [m/s^2]
constexpr int kMaxIterations = 40;    ///< a start against a wall takes about 30, steady driving one or two
constexpr double kConverged = 1e-9;   ///< largest impulse change that counts as none [N s]
constexpr double kCreepSpeed = 0.02;  ///< below it the slip ratio is taken as if at this speed [m/s]

double dot(const TPoint2D& a, const TPoint2D& b) { return a.x * b.x + a.y * b.y; }
double cross(const TPoint2D& a, const TPoint2D& b) { return a.x * b.y - a.y * b.x; }

}  // namespace

/// The five speeds, and how impulses change them. On a slope a horizontal push also has to lift the body: with the
/// mean gradient g the mass in the plan is m (I + g g^T), its inverse (I - g g^T / (1 + |g|^2)) / m.
struct Drive::Motion {
  TPoint2D u;                  ///< plan velocity [m/s]
  double w = 0.0;              ///< [rad/s]
  std::array<double, 2> rims;  ///< left, right [m/s]
  double inverse_mass = 0.0;
  double inverse_inertia = 0.0;
  TPoint2D gradient;

  TPoint2D mobility(const TPoint2D& direction) const {
    const double along = dot(gradient, direction) / (1.0 + dot(gradient, gradient));
    return {inverse_mass * (direction.x - along * gradient.x), inverse_mass * (direction.y - along * gradient.y)};
  }
  void push(const TPoint2D& impulse, double torque_impulse) {
    const TPoint2D du = mobility(impulse);
    u.x += du.x;
    u.y += du.y;
    w += inverse_inertia * torque_impulse;
  }
};

/// A wheel's contact in this step. `forward` and `left` are the plan directions scaled by the path length on the slope
/// per plan length, so that dot(forward, u) is the speed along the slope.
struct Drive::Wheel {
  TPoint2D arm;  ///< from the base to the foot, world axes [m]
  TPoint2D forward, left;
  double forward_arm = 0.0, left_arm = 0.0;  ///< cross(arm, direction)
  double kxx = 0.0, kyy = 0.0, kxy = 0.0;    ///< slip per impulse
  double softness = 0.0;                     ///< slip a held impulse leaves: loose paper [m/s per N s]
  double limit = 0.0;                        ///< radius of the friction circle [N s]
  double ruck_limit = 0.0;                   ///< [N s]
  std::size_t side = 0;

  TPoint2D slip(const Motion& m) const {
    return {m.rims[side] - dot(forward, m.u) - forward_arm * m.w, -dot(left, m.u) - left_arm * m.w};
  }
  void push(Motion& m, double along, double across, double inverse_rim_mass) const {
    m.push({along * forward.x + across * left.x, along * forward.y + across * left.y},
           along * forward_arm + across * left_arm);
    m.rims[side] -= along * inverse_rim_mass;
  }
};

std::array<TPoint2D, 4> wheel_feet(const robot::RobotModel& model) {
  const double x = 0.5 * model.wheelbase;
  const double y = 0.5 * model.track;
  return {TPoint2D{x, y}, TPoint2D{-x, y}, TPoint2D{x, -y}, TPoint2D{-x, -y}};
}

Drive::Drive(const Terrain& terrain, const robot::RobotModel& model, const DriveParameters& parameters)
    : terrain_(terrain),
      model_(model),
      parameters_(parameters),
      yaw_inertia_(model.mass * (model.length * model.length + model.width * model.width) / 12.0) {}

/// Vertical load of each wheel [N]: a quarter each, shifted downhill by the height of the centre of mass, and shifted
/// to the diagonal that the uneven floor lifts, as far as the tyres give.
std::array<double, 4> Drive::loads() const {
  const double weight = model_.mass * kGravity;
  const double front = 0.5 * (ground_[0].height + ground_[2].height);
  const double rear = 0.5 * (ground_[1].height + ground_[3].height);
  const double left = 0.5 * (ground_[0].height + ground_[1].height);
  const double right = 0.5 * (ground_[2].height + ground_[3].height);
  const double pitch = (front - rear) / model_.wheelbase;
  const double roll = (left - right) / model_.track;
  const double twist = 0.25 * (ground_[0].height - ground_[1].height - ground_[2].height + ground_[3].height);
  const double to_rear = 0.5 * weight * parameters_.centre_of_mass * pitch / model_.wheelbase;
  const double to_right = 0.5 * weight * parameters_.centre_of_mass * roll / model_.track;
  const double diagonal = parameters_.tyre_stiffness * twist;
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

PlanVelocity Drive::step(const TPose2D& pose, const PlanVelocity& before, const SideDemand& demand,
                         const std::vector<Stop>& stops, double dt) {
  const double c = std::cos(pose.phi);
  const double s = std::sin(pose.phi);
  const TPoint2D forward{c, s};
  const TPoint2D left{-s, c};
  const std::array<TPoint2D, 4> feet = wheel_feet(model_);
  std::array<Wheel, 4> wheels;
  for (std::size_t i = 0; i < 4; ++i) {
    wheels[i].arm = {c * feet[i].x - s * feet[i].y, s * feet[i].x + c * feet[i].y};
    wheels[i].side = i < 2 ? 0 : 1;
    ground_[i] = terrain_.under_wheel({pose.x + wheels[i].arm.x, pose.y + wheels[i].arm.y});
  }
  const std::array<double, 4> load = loads();

  Motion m;
  m.u = {before.x, before.y};
  m.w = before.w;
  m.rims = {sides_[0].speed, sides_[1].speed};
  m.inverse_mass = 1.0 / model_.mass;
  m.inverse_inertia = 1.0 / yaw_inertia_;
  const double weight = model_.mass * kGravity;
  for (std::size_t i = 0; i < 4; ++i) {
    m.gradient.x += load[i] / weight * ground_[i].gx;
    m.gradient.y += load[i] / weight * ground_[i].gy;
  }

  // Gravity: each wheel's normal force leans downhill; together they pull with the slope of the potential energy.
  for (std::size_t i = 0; i < 4; ++i) {
    const TPoint2D pull{-load[i] * ground_[i].gx * dt, -load[i] * ground_[i].gy * dt};
    m.push(pull, cross(wheels[i].arm, pull));
  }

  const double inverse_rim_mass = 1.0 / parameters_.rotating_mass;
  for (std::size_t i = 0; i < 4; ++i) {
    Wheel& wheel = wheels[i];
    const Ground& g = ground_[i];
    const double rise_forward = g.gx * forward.x + g.gy * forward.y;
    const double rise_left = g.gx * left.x + g.gy * left.y;
    const double stretch_forward = std::sqrt(1.0 + rise_forward * rise_forward);
    const double stretch_left = std::sqrt(1.0 + rise_left * rise_left);
    wheel.forward = {forward.x * stretch_forward, forward.y * stretch_forward};
    wheel.left = {left.x * stretch_left, left.y * stretch_left};
    wheel.forward_arm = cross(wheel.arm, wheel.forward);
    wheel.left_arm = cross(wheel.arm, wheel.left);
    const TPoint2D forward_mobility = m.mobility(wheel.forward);
    wheel.kxx = dot(wheel.forward, forward_mobility) + m.inverse_inertia * wheel.forward_arm * wheel.forward_arm +
                inverse_rim_mass;
    wheel.kyy = dot(wheel.left, m.mobility(wheel.left)) + m.inverse_inertia * wheel.left_arm * wheel.left_arm;
    wheel.kxy = dot(wheel.left, forward_mobility) + m.inverse_inertia * wheel.forward_arm * wheel.left_arm;
    const double normal = load[i] / std::sqrt(1.0 + g.gx * g.gx + g.gy * g.gy);
    wheel.limit = g.friction * normal * dt;
    if (g.on_sheet && wheel.limit > 0.0) {
      const double speed = std::max({kCreepSpeed, std::abs(m.rims[wheel.side]), std::hypot(m.u.x, m.u.y)});
      wheel.softness = parameters_.sheet_creep * speed / wheel.limit;
      wheel.ruck_limit = parameters_.sheet_resistance * normal * dt;
    }
    // Warm start, cut to this step's friction circle.
    const double size = std::hypot(forward_impulse_[i], lateral_impulse_[i]);
    const double keep = size > wheel.limit ? wheel.limit / size : 1.0;
    forward_impulse_[i] *= keep;
    lateral_impulse_[i] *= keep;
    ruck_impulse_[i] = std::clamp(ruck_impulse_[i], -wheel.ruck_limit, wheel.ruck_limit);
    wheel.push(m, forward_impulse_[i], lateral_impulse_[i], inverse_rim_mass);
    m.push({ruck_impulse_[i] * wheel.forward.x, ruck_impulse_[i] * wheel.forward.y},
           ruck_impulse_[i] * wheel.forward_arm);
  }

  const std::array<double, 2> wanted{demand.relaxed ? 0.0 : demand.left, demand.relaxed ? 0.0 : demand.right};
  const double motor_limit = (demand.relaxed ? parameters_.gear_friction : parameters_.side_force) * dt;
  for (std::size_t k = 0; k < 2; ++k) {
    motor_impulse_[k] = std::clamp(motor_impulse_[k], -motor_limit, motor_limit);
    m.rims[k] += motor_impulse_[k] * inverse_rim_mass;
  }
  std::vector<double> stop_impulse(stops.size(), 0.0);

  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    double change = 0.0;
    for (std::size_t k = 0; k < 2; ++k) {
      const double old = motor_impulse_[k];
      motor_impulse_[k] =
          std::clamp(old + (wanted[k] - m.rims[k]) * parameters_.rotating_mass, -motor_limit, motor_limit);
      m.rims[k] += (motor_impulse_[k] - old) * inverse_rim_mass;
      change = std::max(change, std::abs(motor_impulse_[k] - old));
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const Wheel& wheel = wheels[i];
      const TPoint2D old{forward_impulse_[i], lateral_impulse_[i]};
      const TPoint2D slip = wheel.slip(m);
      const TPoint2D error{slip.x - wheel.softness * old.x, slip.y - wheel.softness * old.y};
      const double kxx = wheel.kxx + wheel.softness;
      const double kyy = wheel.kyy + wheel.softness;
      const double determinant = kxx * kyy - wheel.kxy * wheel.kxy;
      TPoint2D next{old.x + (kyy * error.x - wheel.kxy * error.y) / determinant,
                    old.y + (kxx * error.y - wheel.kxy * error.x) / determinant};
      if (next.x * next.x + next.y * next.y > wheel.limit * wheel.limit) {
        // Sliding: the projection must step equally in both directions, or friction would not oppose the slip.
        const double step_size = 1.0 / std::max(kxx, kyy);
        next = {old.x + step_size * error.x, old.y + step_size * error.y};
        const double size = std::hypot(next.x, next.y);
        if (size > wheel.limit) {
          next.x *= wheel.limit / size;
          next.y *= wheel.limit / size;
        }
      }
      wheel.push(m, next.x - old.x, next.y - old.y, inverse_rim_mass);
      forward_impulse_[i] = next.x;
      lateral_impulse_[i] = next.y;
      change = std::max({change, std::abs(next.x - old.x), std::abs(next.y - old.y)});
      if (wheel.ruck_limit > 0.0) {
        const double ruck_old = ruck_impulse_[i];
        const double speed = dot(wheel.forward, m.u) + wheel.forward_arm * m.w;
        ruck_impulse_[i] =
            std::clamp(ruck_old - speed / (wheel.kxx - inverse_rim_mass), -wheel.ruck_limit, wheel.ruck_limit);
        const double more = ruck_impulse_[i] - ruck_old;
        m.push({more * wheel.forward.x, more * wheel.forward.y}, more * wheel.forward_arm);
        change = std::max(change, std::abs(more));
      }
    }
    for (std::size_t k = 0; k < stops.size(); ++k) {
      const TPoint2D arm{stops[k].point.x - pose.x, stops[k].point.y - pose.y};
      const double turn = cross(arm, stops[k].normal);
      const double speed = dot(stops[k].normal, m.u) + turn * m.w;
      const double inertia = dot(stops[k].normal, m.mobility(stops[k].normal)) + m.inverse_inertia * turn * turn;
      const double old = stop_impulse[k];
      stop_impulse[k] = std::max(0.0, old - speed / inertia);
      const double more = stop_impulse[k] - old;
      m.push({more * stops[k].normal.x, more * stops[k].normal.y}, more * turn);
      change = std::max(change, std::abs(more));
    }
    if (change < kConverged) break;
  }

  for (std::size_t k = 0; k < 2; ++k) {
    sides_[k].speed = m.rims[k];
    sides_[k].travel += m.rims[k] * dt;
    sides_[k].saturated = !demand.relaxed && std::abs(motor_impulse_[k]) >= motor_limit;
  }
  return {m.u.x, m.u.y, m.w};
}

}  // namespace rubble::sim
