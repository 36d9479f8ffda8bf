#pragma once

#include <mrpt/math/TPoint2D.h>

#include <map>
#include <optional>
#include <utility>

namespace rubble::explore {

/// Where the robot's middle was, and the slope it met there: the scanner does not see steps, crossing ramps and slopes.
class PassedFloor {
 public:
  /// The robot was at p_map and leant by `slope` against the horizontal [rad]. The last time counts.
  void add(const mrpt::math::TPoint2D& p_map, double slope);
  void clear() { cells_.clear(); }
  /// The steepest slope within 0.15 to 0.4 m of p_map [rad]; nothing where the robot was not so near.
  std::optional<double> slope(const mrpt::math::TPoint2D& p_map) const;

 private:
  std::map<std::pair<int, int>, double> cells_;
};

}  // namespace rubble::explore
