#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <vector>

#include "base/stamp.h"
#include "explore/anchor.h"
#include "explore/caution/passed_floor.h"
#include "slam/mapper.h"

namespace rubble::explore {

/// Where the robot's middle came along in good order: a point every 0.15 m, oldest first, kept relative to the robot's
/// poses, so that it moves with the map. Where the robot was, there is floor, though no scan may have shown it.
class Trail {
 public:
  /// Takes in where the robot is.
  void add(Stamp now, const mrpt::math::TPose2D& T_map_base);
  /// The mapper corrected its past. Returns by how much the end of the trail moved [m], without limit when there is
  /// none.
  double follow(const slam::Mapper& mapper);

  const std::vector<mrpt::math::TPoint2D>& points() const { return points_; }
  /// Way along it [m].
  double length() const;
  /// The robot was near p_map (PassedFloor).
  bool passed(const mrpt::math::TPoint2D& p_map) const { return passed_.holds(p_map); }

 private:
  std::vector<Anchor> anchors_;
  std::vector<mrpt::math::TPoint2D> points_;  ///< the anchors' places
  PassedFloor passed_;                        ///< these again
};

}  // namespace rubble::explore
