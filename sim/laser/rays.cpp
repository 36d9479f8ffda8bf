#include "sim/laser/rays.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "sim/laser/simd.h"

namespace rubble::sim {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d rotation(double yaw, double pitch, double roll) {
  // Levelled and on flat floor most angles are exactly zero.
  const auto cosine = [](double angle) { return angle == 0.0 ? 1.0 : std::cos(angle); };
  const auto sine = [](double angle) { return angle == 0.0 ? 0.0 : std::sin(angle); };
  const double cy = cosine(yaw), sy = sine(yaw);
  const double cp = cosine(pitch), sp = sine(pitch);
  const double cr = cosine(roll), sr = sine(roll);
  Matrix3d R;
  R << cy * cp, -cy * sp * sr - sy * cr, -cy * sp * cr + sy * sr,  //
      sy * cp, -sy * sp * sr + cy * cr, -sy * sp * cr - cy * sr,   //
      sp, cp * sr, cp * cr;
  return R;
}

Placement base_placement(const WorldState& state) {
  return {rotation(state.pose.phi, state.stance.pitch, state.stance.roll),
          Vector3d(state.pose.x, state.pose.y, state.stance.z)};
}

LaserMount::LaserMount(const robot::RobotModel& model)
    : p(model.T_base_laser.x, model.T_base_laser.y, model.T_base_laser.z),
      // mrpt counts pitch nose down.
      R(rotation(model.T_base_laser.yaw, -model.T_base_laser.pitch, model.T_base_laser.roll)) {}

Placement laser_placement(const WorldState& state, const LaserMount& mount) {
  const Placement base = base_placement(state);
  return {base.R * rotation(0.0, state.aim.pitch, state.aim.roll) * mount.R, base.p + base.R * mount.p};
}

Placement laser_placement(const WorldState& state, const robot::RobotModel& model) {
  return laser_placement(state, LaserMount(model));
}

Ray Beams::ray(std::size_t beam) const {
  Ray ray;
  ray.origin = middle.p + Vector3d(ox[beam], oy[beam], oz[beam]);
  ray.direction = Vector3d(dx[beam], dy[beam], dz[beam]).normalized();
  return ray;
}

BeamTable::BeamTable(const robot::LaserModel& laser)
    : count(static_cast<std::size_t>(laser.beams)),
      angle_min(laser.angle_min),
      angle_step(laser.angle_step),
      beams_per_radian(1.0 / laser.angle_step) {
  const std::size_t padded = (count + 3) / 4 * 4;
  for (std::size_t i = 0; i < padded; ++i) {
    const double bearing = angle_min + static_cast<double>(i) * angle_step;
    cosine.push_back(static_cast<float>(std::cos(bearing)));
    sine.push_back(static_cast<float>(std::sin(bearing)));
  }
}

namespace {

/// The laser between two states that follow each other.
struct Interval {
  Placement from, to;
  double t0 = 0.0, t1 = 0.0;  ///< after the first beam [s]
};

Placement blend(const Interval& interval, double t) {
  const double u = (t - interval.t0) / (interval.t1 - interval.t0);
  Placement p{interval.from.R + u * (interval.to.R - interval.from.R),
              interval.from.p + u * (interval.to.p - interval.from.p)};
  p.R.col(0).normalize();
  p.R.col(1) = (p.R.col(1) - p.R.col(0) * p.R.col(0).dot(p.R.col(1))).normalized();
  p.R.col(2) = p.R.col(0).cross(p.R.col(1));
  return p;
}

/// Fills beams [begin, end), both multiples of four.
void fill(const Interval& interval, const BeamTable& table, double beam_period, std::size_t begin, std::size_t end,
          Beams& beams) {
  const double span = interval.t1 - interval.t0;
  const Float4 first_u = splat(static_cast<float>(-interval.t0 / span));
  const Float4 each_u = splat(static_cast<float>(beam_period / span));
  const Float4 lanes{0.0f, 1.0f, 2.0f, 3.0f};
  Float4 p[3], dp[3], c0[3], dc0[3], c1[3], dc1[3];
  for (int k = 0; k < 3; ++k) {
    p[k] = splat(static_cast<float>(interval.from.p[k] - beams.middle.p[k]));
    dp[k] = splat(static_cast<float>(interval.to.p[k] - interval.from.p[k]));
    c0[k] = splat(static_cast<float>(interval.from.R(k, 0)));
    c1[k] = splat(static_cast<float>(interval.from.R(k, 1)));
    dc0[k] = splat(static_cast<float>(interval.to.R(k, 0) - interval.from.R(k, 0)));
    dc1[k] = splat(static_cast<float>(interval.to.R(k, 1) - interval.from.R(k, 1)));
  }
  for (std::size_t i = begin; i < end; i += 4) {
    const Float4 u = first_u + (splat(static_cast<float>(i)) + lanes) * each_u;
    const Float4 c = load4(&table.cosine[i]);
    const Float4 s = load4(&table.sine[i]);
    const Float4 x = c * (c0[0] + u * dc0[0]) + s * (c1[0] + u * dc1[0]);
    const Float4 y = c * (c0[1] + u * dc0[1]) + s * (c1[1] + u * dc1[1]);
    const Float4 z = c * (c0[2] + u * dc0[2]) + s * (c1[2] + u * dc1[2]);
    // One Newton step from 1: between two states 3 deg apart the length is 1 to 4e-4, afterwards to 6e-8.
    const Float4 scale = splat(1.5f) - splat(0.5f) * (x * x + y * y + z * z);
    store4(&beams.ox[i], p[0] + u * dp[0]);
    store4(&beams.oy[i], p[1] + u * dp[1]);
    store4(&beams.oz[i], p[2] + u * dp[2]);
    store4(&beams.dx[i], x * scale);
    store4(&beams.dy[i], y * scale);
    store4(&beams.dz[i], z * scale);
  }
}

}  // namespace

Placement laser_placement_at(const std::vector<WorldState>& states, const robot::RobotModel& model, Stamp stamp) {
  std::size_t next = 0;
  while (next + 1 < states.size() && states[next].stamp < stamp) ++next;
  const std::size_t before = next > 0 ? next - 1 : 0;
  Interval interval{laser_placement(states[before], model), laser_placement(states[next], model), 0.0, 0.0};
  interval.t0 = states[before].stamp - stamp;
  interval.t1 = states[next].stamp - stamp;
  return interval.t1 > interval.t0 ? blend(interval, std::min(0.0, interval.t1)) : interval.to;
}

bool at_rest(const std::vector<WorldState>& states, Stamp from, Stamp to) {
  constexpr double kStill = 1e-4;         // [m]
  constexpr double kStillAngle = 1.7e-5;  // [rad]
  const WorldState* first = nullptr;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const WorldState& s = states[i];
    if (i + 1 < states.size() && states[i + 1].stamp <= from) continue;
    if (first == nullptr) first = &s;
    const WorldState& f = *first;
    const bool still = std::abs(s.pose.x - f.pose.x) < kStill && std::abs(s.pose.y - f.pose.y) < kStill &&
                       std::abs(s.stance.z - f.stance.z) < kStill && std::abs(s.pose.phi - f.pose.phi) < kStillAngle &&
                       std::abs(s.stance.pitch - f.stance.pitch) < kStillAngle &&
                       std::abs(s.stance.roll - f.stance.roll) < kStillAngle &&
                       std::abs(s.aim.pitch - f.aim.pitch) < kStillAngle &&
                       std::abs(s.aim.roll - f.aim.roll) < kStillAngle;
    if (!still) return false;
    if (s.stamp >= to) break;
  }
  return true;
}

void swept_beams(const std::vector<WorldState>& states, const robot::RobotModel& model, const BeamTable& table,
                 Stamp first, double beam_period, Beams& beams) {
  assert(!states.empty());
  const std::size_t padded = table.cosine.size();
  beams.count = table.count;
  for (auto* list : {&beams.ox, &beams.oy, &beams.oz, &beams.dx, &beams.dy, &beams.dz}) list->resize(padded);

  const double last = static_cast<double>(table.count - 1) * beam_period;
  const LaserMount mount(model);
  std::vector<Interval> intervals;
  std::size_t next = 0;
  while (next + 1 < states.size() && states[next].stamp <= first) ++next;
  intervals.reserve(states.size() - next);
  Placement from = laser_placement(states[next > 0 ? next - 1 : 0], mount);
  for (;; ++next) {
    Interval interval;
    interval.from = from;
    interval.to = laser_placement(states[next], mount);
    interval.t0 = states[next > 0 ? next - 1 : 0].stamp - first;
    interval.t1 = std::max(interval.t0 + 1e-6, states[next].stamp - first);
    intervals.push_back(interval);
    from = interval.to;
    if (interval.t1 >= last || next + 1 == states.size()) break;
  }

  const double half = 0.5 * last;
  std::size_t at = 0;
  while (at + 1 < intervals.size() && intervals[at].t1 < half) ++at;
  beams.middle = blend(intervals[at], half);
  beams.travel = beams.lift = beams.turn = beams.tilt = 0.0;
  for (const Interval& interval : intervals) {
    for (const Placement* p : {&interval.from, &interval.to}) {
      if (p == &interval.from && &interval != intervals.data()) continue;  // the end of the one before
      const Vector3d moved = p->p - beams.middle.p;
      const Vector3d ahead = beams.middle.R.transpose() * p->R.col(0);
      const double leaning = (p->R.col(2) - beams.middle.R.col(2)).norm();  // 2 sin(angle / 2)
      beams.travel = std::max(beams.travel, moved.norm());
      beams.lift = std::max(beams.lift, std::abs(moved.dot(beams.middle.R.col(2))));
      beams.turn = std::max(beams.turn, std::atan2(std::abs(ahead.y()), ahead.x()));
      beams.tilt = std::max(beams.tilt, 1.05 * leaning);
    }
  }

  std::size_t begin = 0;
  for (std::size_t k = 0; k < intervals.size() && begin < padded; ++k) {
    std::size_t end = padded;
    if (k + 1 < intervals.size()) {
      // Groups of four stay together: a beam may be taken from the neighbouring interval's line, 0.3 ms beyond its end.
      const double beams_until = intervals[k].t1 / beam_period;
      end = std::min(padded, static_cast<std::size_t>(std::max(0.0, beams_until / 4.0 + 0.5)) * 4);
    }
    fill(intervals[k], table, beam_period, begin, end, beams);
    begin = std::max(begin, end);
  }
}

}  // namespace rubble::sim
