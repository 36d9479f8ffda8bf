#include "sim/rays.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace rubble::sim {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d rotation(double yaw, double pitch, double roll) {
  const double cy = std::cos(yaw), sy = std::sin(yaw);
  const double cp = std::cos(pitch), sp = std::sin(pitch);
  const double cr = std::cos(roll), sr = std::sin(roll);
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

Placement laser_placement(const WorldState& state, const robot::RobotModel& model) {
  const Placement base = base_placement(state);
  const mrpt::math::TPose3D& mount = model.T_base_laser;
  // mrpt counts pitch nose down.
  return {base.R * rotation(0.0, state.aim.pitch, state.aim.roll) * rotation(mount.yaw, -mount.pitch, mount.roll),
          base.p + base.R * Vector3d(mount.x, mount.y, mount.z)};
}

void Beams::resize(std::size_t n) {
  for (auto* list : {&ox, &oy, &oz, &dx, &dy, &dz}) list->resize(n);
}

Ray Beams::ray(std::size_t beam) const {
  Ray ray;
  ray.origin = reference + Vector3d(ox[beam], oy[beam], oz[beam]);
  ray.direction = Vector3d(dx[beam], dy[beam], dz[beam]).normalized();
  return ray;
}

BeamTable::BeamTable(const robot::LaserModel& laser) {
  for (int i = 0; i < laser.beams; ++i) {
    const double bearing = laser.angle_min + i * laser.angle_step;
    cosine.push_back(std::cos(bearing));
    sine.push_back(std::sin(bearing));
  }
}

void swept_beams(const std::vector<WorldState>& states, const robot::RobotModel& model, const BeamTable& table,
                 Stamp first, Beams& beams) {
  assert(!states.empty());
  const std::size_t n = table.cosine.size();
  beams.resize(n);
  const double period = model.laser.beam_period;
  std::size_t next = 0;
  while (next + 1 < states.size() && states[next].stamp <= first) ++next;
  Placement to = laser_placement(states[next], model);
  Placement from = next > 0 ? laser_placement(states[next - 1], model) : to;
  beams.reference = from.p;
  for (std::size_t i = 0; i < n; ++next) {
    const std::size_t before = next > 0 ? next - 1 : 0;
    const double span = std::max(1e-9, states[next].stamp - states[before].stamp);
    const double t0 = first - states[before].stamp;
    // Beams up to the later state; the last interval takes the rest.
    std::size_t end = n;
    if (next + 1 < states.size()) {
      const double count = period > 0.0 ? std::ceil((span - t0) / period) : static_cast<double>(n);
      end = std::min(n, static_cast<std::size_t>(std::max(0.0, count)));
    }
    const Vector3d p0 = from.p - beams.reference;
    const Vector3d dp = to.p - from.p;
    const Matrix3d dR = to.R - from.R;
    for (; i < end; ++i) {
      const double u = std::min(1.0, (t0 + static_cast<double>(i) * period) / span);
      const double c = table.cosine[i];
      const double s = table.sine[i];
      const double x = c * (from.R(0, 0) + u * dR(0, 0)) + s * (from.R(0, 1) + u * dR(0, 1));
      const double y = c * (from.R(1, 0) + u * dR(1, 0)) + s * (from.R(1, 1) + u * dR(1, 1));
      const double z = c * (from.R(2, 0) + u * dR(2, 0)) + s * (from.R(2, 1) + u * dR(2, 1));
      const double scale = 1.0 / std::sqrt(x * x + y * y + z * z);
      beams.ox[i] = static_cast<float>(p0.x() + u * dp.x());
      beams.oy[i] = static_cast<float>(p0.y() + u * dp.y());
      beams.oz[i] = static_cast<float>(p0.z() + u * dp.z());
      beams.dx[i] = static_cast<float>(x * scale);
      beams.dy[i] = static_cast<float>(y * scale);
      beams.dz[i] = static_cast<float>(z * scale);
    }
    if (next + 1 < states.size()) {
      from = to;
      to = laser_placement(states[next + 1], model);
    }
  }
}

}  // namespace rubble::sim
