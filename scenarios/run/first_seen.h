#pragma once

#include <mrpt/math/TPoint2D.h>

#include "base/grid.h"
#include "slam/mapper.h"

namespace rubble::scenarios {

/// When each place of a map was seen first. Corrections of the map do not move what was noted before.
class FirstSeen {
 public:
  /// Notes what the map shows at `time` [s], which does not fall.
  void note(const slam::CountMap& map, double time);
  /// Of the place [m, map frame]; inf: never [s].
  double at(const mrpt::math::TPoint2D& p_map) const;

 private:
  void cover(const GridFrame& frame);

  Grid<float> first_;
};

}  // namespace rubble::scenarios
