#pragma once

#include <algorithm>
#include <cmath>

#include "robot/model.h"

namespace rubble::robot {

/// The same scan with its beams in the other order: its last beam is the first.
inline void reverse_beams(LaserScan& scan) {
  if (scan.ranges.empty()) return;
  const std::size_t last = scan.ranges.size() - 1;
  scan.stamp = scan.beam_stamp(last);
  scan.beam_period = -scan.beam_period;
  scan.angle_min = scan.bearing(last);
  scan.angle_step = -scan.angle_step;
  std::reverse(scan.ranges.begin(), scan.ranges.end());
  std::reverse(scan.codes.begin(), scan.codes.end());
}

/// Whether the beams run clockwise, and in a time that a sweep can take.
inline bool is_clockwise(const LaserScan& scan) {
  constexpr double kLongestSweep = 100.0;  // [s]
  return scan.angle_step < 0.0 && !scan.ranges.empty() &&
         std::abs(scan.beam_period) * static_cast<double>(scan.ranges.size()) <= kLongestSweep;
}

inline Inputs counter_clockwise(Inputs inputs) {
  for (LaserScan& scan : inputs.scans)
    if (is_clockwise(scan)) reverse_beams(scan);
  return inputs;
}

inline RobotModel counter_clockwise(RobotModel model) {
  LaserModel& laser = model.laser;
  if (!(laser.angle_step < 0.0)) return model;
  laser.angle_min += laser.field_of_view();
  laser.angle_step = -laser.angle_step;
  return model;
}

}  // namespace rubble::robot
