#pragma once

#include <mrpt/math/TPoint2D.h>

#include <set>
#include <utility>

namespace rubble::explore {

/// Where the robot's middle was: the scanner does not see steps and crossing ramps, and there the wheels met none.
class PassedFloor {
 public:
  void add(const mrpt::math::TPoint2D& p_map);
  void clear() { cells_.clear(); }
  /// The robot was within 0.15 to 0.4 m of p_map.
  bool holds(const mrpt::math::TPoint2D& p_map) const;

 private:
  std::set<std::pair<int, int>> cells_;
};

}  // namespace rubble::explore
