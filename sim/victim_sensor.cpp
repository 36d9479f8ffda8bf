#include "sim/victim_sensor.h"

#include <algorithm>
#include <cmath>

#include "sim/rays.h"

namespace rubble::sim {
namespace {

constexpr double kReached = 0.12;  ///< a victim is not a point: a ray that ends so near has reached it [m]

}  // namespace

VictimSensor::VictimSensor(const std::vector<arenas::Victim>& victims, const VictimSensorParameters& parameters,
                           std::uint64_t seed)
    : victims_(victims), parameters_(parameters), rng_(seed, "victim") {}

bool VictimSensor::in_view(const arenas::Victim& victim, const WorldState& state, const RayWalk& walk) const {
  const double dx = victim.position.x - state.pose.x;
  const double dy = victim.position.y - state.pose.y;
  const double distance = std::hypot(dx, dy);
  if (distance > parameters_.range || distance < 1e-6) return false;
  const double bearing = wrap_angle(std::atan2(dy, dx) - state.pose.phi);
  if (std::abs(bearing) > 0.5 * parameters_.field_of_view) return false;
  if (std::abs(wrap_angle(std::atan2(-dy, -dx) - victim.facing)) > parameters_.open_side) return false;
  const Placement base = base_placement(state);
  Ray ray;
  ray.origin = base.p + base.R * Eigen::Vector3d(0.0, 0.0, parameters_.height);
  const Eigen::Vector3d to = Eigen::Vector3d(victim.position.x, victim.position.y, victim.position.z) - ray.origin;
  ray.direction = to.normalized();
  return walk.cast(ray, to.norm()) >= to.norm() - kReached;
}

std::vector<robot::VictimCue> VictimSensor::look(const WorldState& state, const RayWalk& walk) {
  std::vector<robot::VictimCue> cues;
  for (const robot::CueKind kind : {robot::CueKind::Appearance, robot::CueKind::Heat}) {
    for (const arenas::Victim& victim : victims_) {
      const bool gives = kind == robot::CueKind::Heat ? victim.heat : victim.appearance;
      if (!gives || !in_view(victim, state, walk)) continue;
      const double overlooked = rng_.uniform();
      const double bearing_error = rng_.gaussian(parameters_.bearing_sigma);
      const double range_error = rng_.gaussian(parameters_.range_sigma);
      const double confidence = rng_.uniform(0.6, 1.0);
      if (overlooked < parameters_.miss) continue;
      const double dx = victim.position.x - state.pose.x;
      const double dy = victim.position.y - state.pose.y;
      cues.push_back({state.stamp, kind, wrap_angle(std::atan2(dy, dx) - state.pose.phi + bearing_error),
                      std::max(0.0, std::hypot(dx, dy) * (1.0 + range_error)), confidence});
    }
    const double alarm = rng_.uniform();
    if (alarm < parameters_.false_alarm) {
      const double half = 0.5 * parameters_.field_of_view;
      const double bearing = rng_.uniform(-half, half);
      const double range = rng_.uniform(0.3, parameters_.range);
      const double confidence = rng_.uniform(0.3, 0.7);
      cues.push_back({state.stamp, kind, bearing, range, confidence});
    }
  }
  return cues;
}

}  // namespace rubble::sim
