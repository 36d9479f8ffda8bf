#include "sim/laser.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"

namespace rubble::sim {

SweepTimes::SweepTimes(const robot::LaserModel& laser) {
  constexpr double kRotorZero = -0.75 * kPi;
  first_beam = std::max(0.0, (laser.angle_min - kRotorZero) / laser.angle_step * laser.beam_period);
  const double last_beam = first_beam + (laser.beams - 1) * laser.beam_period;
  sent = std::max(last_beam, 1.5 * kPi / laser.angle_step * laser.beam_period);
}

Laser::Laser(const arenas::Arena& arena, const robot::RobotModel& model, double noise, bool sweep, std::uint64_t seed)
    : model_(model),
      sweep_(sweep),
      times_(model.laser),
      table_(model.laser),
      walk_(arenas::faces(arena)),
      noise_(model.laser, noise, seed) {}

robot::LaserScan Laser::scan(Stamp first, const std::vector<WorldState>& states, const std::vector<Sphere>& balls) {
  robot::LaserScan scan;
  scan.stamp = first;
  scan.angle_min = model_.laser.angle_min;
  scan.angle_step = model_.laser.angle_step;
  scan.beam_period = sweep_ ? model_.laser.beam_period : 0.0;
  scan.range_min = model_.laser.range_min;
  scan.range_max = model_.laser.range_max;
  robot::RobotModel timing = model_;
  timing.laser.beam_period = scan.beam_period;
  swept_beams(states, timing, table_, first, beams_);
  const std::size_t n = beams_.size();
  scan.ranges.resize(n);
  const double reach = model_.laser.range_max + 1.0;
  std::vector<Sphere> near;
  for (const Sphere& ball : balls) {
    const double distance = std::hypot(ball.x - beams_.reference.x(), ball.y - beams_.reference.y());
    if (distance < reach + ball.radius) near.push_back(ball);
  }
  for (std::size_t i = 0; i < n; ++i) {
    scan.ranges[i] = static_cast<float>(walk_.cast(beams_.ray(i), model_.laser.range_max + 0.1, near));
  }
  noise_.apply(scan.ranges);
  return scan;
}

}  // namespace rubble::sim
