#include "slam/robust/map/packed_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rubble::slam {

namespace {

constexpr std::uint16_t kUnknown = 0;
constexpr std::uint16_t kMiss = std::numeric_limits<std::uint16_t>::max();
constexpr double kLeastStep = 1e-6;       ///< between two beams [rad]
constexpr float kFinestQuantum = 0.002F;  ///< [m]: scanners measure to millimetres, and cells are centimetres

}  // namespace

bool has_directions(double angle_min, double angle_step, std::size_t beams) {
  const bool apart = angle_step > kLeastStep || (beams < 2 && angle_step >= 0.0);
  return std::abs(angle_min) <= kMostAngle && apart && angle_step <= kMostAngle;
}

PackedScan packed(const robot::LaserScan& scan, const std::optional<SweepMotion>& motion,
                  const std::optional<ScanTilt>& tilt) {
  PackedScan out;
  out.angle_min = scan.angle_min;
  out.angle_step = scan.angle_step;
  const auto possible = [](double range) { return range >= 0.0 && range <= kFarthestReturn; };
  out.range_min = possible(scan.range_min) ? static_cast<float>(scan.range_min) : 0.0F;
  out.range_max = possible(scan.range_max) ? static_cast<float>(scan.range_max) : 0.0F;
  out.motion = motion;
  out.tilt = tilt;
  const auto least = static_cast<float>(scan.range_min);
  float farthest = 0.0F;
  for (const float range : scan.ranges)
    if (possible(static_cast<double>(range))) farthest = std::max(farthest, range);
  out.quantum = std::max(kFinestQuantum, farthest / (kMiss - 1.0F));
  out.ranges.reserve(scan.ranges.size());
  for (const float range : scan.ranges) {
    const bool known = range > 0.0F && range >= least;
    const float steps = possible(static_cast<double>(range)) ? std::max(1.0F, std::round(range / out.quantum)) : kMiss;
    out.ranges.push_back(known ? static_cast<std::uint16_t>(std::min<float>(steps, kMiss)) : kUnknown);
  }
  return out;
}

robot::LaserScan unpacked(const PackedScan& scan) {
  robot::LaserScan out;
  out.angle_min = scan.angle_min;
  out.angle_step = scan.angle_step;
  out.range_min = 0.0;
  out.range_max = static_cast<double>(scan.range_max);
  out.ranges.reserve(scan.ranges.size());
  for (const std::uint16_t steps : scan.ranges) {
    if (steps == kUnknown)
      out.ranges.push_back(std::numeric_limits<float>::quiet_NaN());
    else if (steps == kMiss)
      out.ranges.push_back(std::numeric_limits<float>::infinity());
    else
      out.ranges.push_back(static_cast<float>(steps) * scan.quantum);
  }
  return out;
}

}  // namespace rubble::slam
