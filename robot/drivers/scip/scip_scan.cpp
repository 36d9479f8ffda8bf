#include "robot/drivers/scip/scip_scan.h"

#include <algorithm>

#include "robot/drivers/scip/scip_text.h"

namespace rubble::robot::scip {

LaserScan scan_of(const Sweep& sweep, const Geometry& geometry, const RangeRules& rules, Stamp turn) {
  LaserScan scan;
  scan.stamp = turn + geometry.first_step * geometry.step_time();
  scan.angle_min = (geometry.first_step - geometry.front_step) * geometry.step_angle();
  scan.angle_step = geometry.step_angle();
  scan.beam_period = geometry.step_time();
  scan.range_min = 0.001 * std::max(geometry.least_mm, static_cast<int>(kFirstRange));
  scan.range_max = std::min(rules.range_max, 0.001 * geometry.most_mm);
  scan.ranges.reserve(sweep.values.size());
  scan.codes.reserve(sweep.values.size());
  for (const std::uint32_t value : sweep.values) {
    const bool is_code = value < kFirstRange;
    // As the simulator and a log in whole millimetres have it: float of the product.
    const double range = 0.001 * value;
    scan.codes.push_back(is_code ? static_cast<std::uint8_t>(value) : std::uint8_t{0});
    if (is_code) {
      scan.ranges.push_back(value == kNoEcho && rules.no_echo_is_miss ? LaserScan::kMiss : LaserScan::kUnknown);
    } else if (range > scan.range_max) {
      scan.ranges.push_back(LaserScan::kMiss);
    } else {
      scan.ranges.push_back(range < scan.range_min ? LaserScan::kUnknown : static_cast<float>(value * 0.001));
    }
  }
  return scan;
}

}  // namespace rubble::robot::scip
