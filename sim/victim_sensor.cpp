#include "sim/victim_sensor.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/laser/rays.h"

namespace rubble::sim {
namespace {

constexpr double kReached = 0.12;  ///< a victim is not a point: a ray that ends so near has reached it [m]

bool gives(const arenas::Victim& victim, robot::CueKind kind) {
  switch (kind) {
    case robot::CueKind::Appearance:
      return victim.appearance;
    case robot::CueKind::Heat:
      return victim.heat;
    case robot::CueKind::Sound:
      return victim.sound;
    case robot::CueKind::Co2:
      return victim.co2;
  }
  return false;
}

bool is_free(const Eigen::Vector3d& eye, const Eigen::Vector3d& to, const RayWalk& walk) {
  const double distance = to.norm();
  return walk.cast({eye, to / distance}, distance) >= distance - kReached;
}

/// Whether the sense can find the victim from `eye`, wherever it is turned to.
bool in_view(const arenas::Victim& victim, const CueSense& sense, const Eigen::Vector3d& eye, const RayWalk& walk) {
  const Eigen::Vector3d to = Eigen::Vector3d(victim.position.x, victim.position.y, victim.position.z) - eye;
  const double distance = std::hypot(to.x(), to.y());
  if (distance > sense.range || distance < 1e-6) return false;
  if (std::abs(wrap_angle(std::atan2(-to.y(), -to.x()) - victim.facing)) > sense.open_side) return false;
  return distance <= sense.muffled_range || is_free(eye, to, walk);
}

}  // namespace

const CueSense& VictimView::sense_for(const arenas::Victim& victim) const {
  if (victim.appearance || victim.heat) return sensors_.appearance;
  return victim.co2 ? sensors_.co2 : sensors_.sound;
}

bool VictimView::find(const arenas::Victim& victim, const mrpt::math::TPoint3D& floor) const {
  return in_view(victim, sense_for(victim), {floor.x, floor.y, floor.z + sensors_.height}, walk_);
}

VictimSensor::VictimSensor(const std::vector<arenas::Victim>& victims, const VictimSensorParameters& parameters,
                           std::uint64_t seed)
    : victims_(victims),
      parameters_(parameters),
      cameras_(seed, "victim"),
      sound_(seed, "victim_sound"),
      co2_(seed, "victim_co2") {}

bool VictimSensor::senses(const CueSense& sense, const arenas::Victim& victim, const WorldState& state) const {
  const double bearing =
      wrap_angle(std::atan2(victim.position.y - state.pose.y, victim.position.x - state.pose.x) - state.pose.phi);
  if (std::abs(bearing) > 0.5 * sense.field_of_view) return false;
  const Placement base = base_placement(state);
  const Eigen::Vector3d eye = base.p + base.R * Eigen::Vector3d(0.0, 0.0, parameters_.height);
  return in_view(victim, sense, eye, *walk_) && (others_ == nullptr || in_view(victim, sense, eye, *others_));
}

void VictimSensor::look(const CueSense& sense, const WorldState& state, Rng& rng,
                        std::vector<robot::VictimCue>& cues) const {
  if (!sense.fitted) return;
  for (const arenas::Victim& victim : victims_) {
    if (!gives(victim, sense.kind) || !senses(sense, victim, state)) continue;
    const double overlooked = rng.uniform();
    const double bearing_error = rng.gaussian(sense.bearing_sigma);
    const double range_error = rng.gaussian(sense.range_sigma);
    const double confidence = rng.uniform(0.6, 1.0);
    if (overlooked < sense.miss) continue;
    const double dx = victim.position.x - state.pose.x;
    const double dy = victim.position.y - state.pose.y;
    cues.push_back({state.stamp, sense.kind, wrap_angle(std::atan2(dy, dx) - state.pose.phi + bearing_error),
                    std::max(0.0, std::hypot(dx, dy) * (1.0 + range_error)), confidence * sense.surest});
  }
  const double alarm = rng.uniform();
  if (alarm < sense.false_alarm) {
    const double half = 0.5 * sense.field_of_view;
    const double bearing = rng.uniform(-half, half);
    const double range = rng.uniform(std::min(0.3, sense.range), sense.range);
    const double confidence = rng.uniform(0.3, 0.7);
    cues.push_back({state.stamp, sense.kind, bearing, range, confidence * sense.surest});
  }
}

std::vector<robot::VictimCue> VictimSensor::look(const WorldState& state, const RayWalk& walk,
                                                 const std::vector<arenas::Face>& moving) {
  std::optional<RayWalk> others;
  if (!moving.empty()) others.emplace(moving);
  walk_ = &walk;
  others_ = others ? &*others : nullptr;
  std::vector<robot::VictimCue> cues;
  look(parameters_.appearance, state, cameras_, cues);
  look(parameters_.heat, state, cameras_, cues);
  look(parameters_.sound, state, sound_, cues);
  look(parameters_.co2, state, co2_, cues);
  walk_ = others_ = nullptr;
  return cues;
}

}  // namespace rubble::sim
