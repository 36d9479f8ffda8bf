#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "robot/measurements.h"
#include "slam/scan/level_scan.h"

namespace rubble::slam {

/// Angles may have been summed up over turns; beyond this they are damage [rad].
constexpr double kMostAngle = 1e6;

/// Whether the beams of a scan point somewhere. What is mapped and what a map's file may hold is the same: else a map
/// could not be read back. Of a single beam no angle to the next one need be told.
bool has_directions(double angle_min, double angle_step, std::size_t beams);

/// A scan kept for later stamping: two bytes a beam, with how robot and plane moved and leant.
struct PackedScan {
  double angle_min = 0.0;   ///< [rad]
  double angle_step = 0.0;  ///< [rad]
  float range_min = 0.0F;   ///< [m]
  float range_max = 0.0F;   ///< [m]
  float quantum = 0.002F;   ///< of the ranges [m]
  std::vector<std::uint16_t> ranges;
  std::optional<SweepMotion> motion;
  std::optional<ScanTilt> tilt;
};

PackedScan packed(const robot::LaserScan& scan, const std::optional<SweepMotion>& motion,
                  const std::optional<ScanTilt>& tilt);

/// The scan again, ranges rounded to the quantum; without stamps.
robot::LaserScan unpacked(const PackedScan& scan);

}  // namespace rubble::slam
