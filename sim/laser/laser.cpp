#include "sim/laser/laser.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"

namespace rubble::sim {
namespace {

constexpr double kBeyond = 0.1;  ///< noise can bring back what lies a little out of range [m]

}  // namespace

SweepTimes::SweepTimes(const robot::LaserModel& laser) {
  constexpr double kRotorZero = -0.75 * kPi;
  first_beam = std::max(0.0, (laser.angle_min - kRotorZero) / laser.angle_step * laser.beam_period);
  const double last_beam = first_beam + (laser.beams - 1) * laser.beam_period;
  sent = std::max(last_beam, 1.5 * kPi / laser.angle_step * laser.beam_period);
}

Laser::Laser(const arenas::Arena& arena, const robot::RobotModel& model, double noise, bool sweep, std::uint64_t seed)
    : Laser(arenas::faces(arena), model, noise, sweep, seed) {}

Laser::Laser(const std::vector<arenas::Face>& faces, const robot::RobotModel& model, double noise, bool sweep,
             std::uint64_t seed)
    : model_(model),
      sweep_(sweep),
      times_(model.laser),
      table_(model.laser),
      walk_(faces),
      faces_(faces),
      plane_cast_(faces_),
      sweep_cast_(faces_),
      noise_(model.laser, noise, seed) {}

robot::LaserScan Laser::scan(Stamp first, const std::vector<WorldState>& states, const std::vector<Sphere>& balls,
                             const std::vector<arenas::Face>& moving) {
  robot::LaserScan scan;
  scan.stamp = first;
  robot::set_geometry(scan, model_.laser);
  if (!sweep_) scan.beam_period = 0.0;
  std::optional<ScanFaces> others;
  if (!moving.empty()) others.emplace(moving);
  const ScanFaces* beside = others ? &*others : nullptr;
  const double reach = model_.laser.range_max + kBeyond;
  if (!sweep_ || at_rest(states, first, scan.beam_stamp(table_.count - 1))) {
    plane_cast_.cast(laser_placement_at(states, model_, first), table_, reach, balls, scan.ranges, beside);
  } else {
    swept_beams(states, model_, table_, first, scan.beam_period, beams_);
    sweep_cast_.cast(beams_, table_, reach, balls, scan.ranges, beside);
  }
  noise_.apply(scan.ranges, model_.laser.has_codes ? &scan.codes : nullptr);
  return scan;
}

}  // namespace rubble::sim
