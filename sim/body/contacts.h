#pragma once

#include <mrpt/math/TPoint2D.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace rubble::sim {

inline double dot(const mrpt::math::TPoint2D& a, const mrpt::math::TPoint2D& b) { return a.x * b.x + a.y * b.y; }
inline double cross(const mrpt::math::TPoint2D& a, const mrpt::math::TPoint2D& b) { return a.x * b.y - a.y * b.x; }

/// A direction in which an impulse acts at a contact, and what a unit of it does to the body.
struct Axis {
  mrpt::math::TPoint2D direction;  ///< plan direction, scaled by path length on the slope per plan length
  double arm = 0.0;                ///< cross(base to contact, direction)
  mrpt::math::TPoint2D du;         ///< change of plan velocity per impulse
  double dw = 0.0;                 ///< change of turn rate per impulse

  /// Change of the speed along the axis per impulse [1/kg].
  double give() const { return dot(direction, du) + arm * dw; }
};

/// What a body resists a push with. On a slope a horizontal push also has to lift the body: with the mean gradient g
/// the mass in the plan is m (I + g g^T), its inverse (I - g g^T / (1 + |g|^2)) / m.
struct Inertia {
  double inverse_mass = 0.0;      ///< [1/kg]
  double inverse_moment = 0.0;    ///< [1/(kg m^2)]
  mrpt::math::TPoint2D gradient;  ///< mean slope under the wheels
  double plan_share = 1.0;        ///< 1 / (1 + |gradient|^2)

  Axis axis(const mrpt::math::TPoint2D& direction, const mrpt::math::TPoint2D& arm) const {
    const double along = dot(gradient, direction) * plan_share;
    const double turn = cross(arm, direction);
    return {direction,
            turn,
            {inverse_mass * (direction.x - along * gradient.x), inverse_mass * (direction.y - along * gradient.y)},
            inverse_moment * turn};
  }
};

/// The body's three speeds and those of the two sides' rims while the impulses of a step are sought.
struct Motion {
  mrpt::math::TPoint2D u;        ///< plan velocity [m/s]
  double w = 0.0;                ///< [rad/s]
  std::array<double, 2> rims;    ///< left, right [m/s]
  std::array<double, 2> pull{};  ///< of the rims on the floor, forwards [N s]
  /// How far an impulse slows the rims down: not at all while the motor is strong enough to hold them [1/kg].
  std::array<double, 2> yielding{};

  double speed(const Axis& a) const { return a.direction.x * u.x + a.direction.y * u.y + a.arm * w; }
  void push(const Axis& a, double impulse) {
    u.x += impulse * a.du.x;
    u.y += impulse * a.du.y;
    w += impulse * a.dw;
  }
};

/// A wheel's contact with the floor in one step.
struct Wheel {
  Axis forward, left;
  double kxx = 0.0, kyy = 0.0, kxy = 0.0;  ///< slip per impulse, softness included, the rims held
  double ixx = 0.0, iyy = 0.0, ixy = 0.0;  ///< impulse per slip: the inverse, for rims held or yielding
  double step = 0.0;                       ///< impulse per slip in any direction: nearly as much as does not overshoot
  double softness = 0.0;                   ///< slip a held impulse leaves: loose paper [m/s per N s]
  double limit = 0.0;                      ///< radius of the friction circle [N s]
  double ruck_limit = 0.0;                 ///< [N s]
  std::size_t side = 0;

  void invert(double yielding) {
    const double xx = kxx + yielding;
    const double inverse = 1.0 / (xx * kyy - kxy * kxy);
    ixx = kyy * inverse;
    iyy = xx * inverse;
    ixy = -kxy * inverse;
    step = 1.0 / std::max(xx, kyy);
  }

  void push(Motion& motion, double along, double across) const {
    motion.push(forward, along);
    motion.push(left, across);
    motion.pull[side] += along;
    motion.rims[side] -= along * motion.yielding[side];
  }

  /// One projection of the wheel's impulse (along, across) onto its friction circle; returns the largest change.
  double roll(Motion& motion, mrpt::math::TPoint2D& impulse) const {
    const double slip_x = motion.rims[side] - motion.speed(forward) - softness * impulse.x;
    const double slip_y = -motion.speed(left) - softness * impulse.y;
    mrpt::math::TPoint2D next{impulse.x + ixx * slip_x + ixy * slip_y, impulse.y + iyy * slip_y + ixy * slip_x};
    if (dot(next, next) > limit * limit) {
      // Sliding: the projection must step equally in both directions, or friction would not oppose the slip.
      next = {impulse.x + step * slip_x, impulse.y + step * slip_y};
      const double size2 = dot(next, next);
      if (size2 > limit * limit) {
        const double cut = limit / std::sqrt(size2);
        next.x *= cut;
        next.y *= cut;
      }
    }
    const mrpt::math::TPoint2D more{next.x - impulse.x, next.y - impulse.y};
    push(motion, more.x, more.y);
    impulse = next;
    return std::max(std::abs(more.x), std::abs(more.y));
  }

  /// Loose paper rucks up before a wheel and resists its way, whatever the wheel turns.
  double ruck(Motion& motion, double& impulse) const {
    if (ruck_limit == 0.0) return 0.0;
    const double old = impulse;
    impulse = std::clamp(old - motion.speed(forward) / forward.give(), -ruck_limit, ruck_limit);
    motion.push(forward, impulse - old);
    return std::abs(impulse - old);
  }
};

}  // namespace rubble::sim
