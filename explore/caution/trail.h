#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <optional>
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
  /// Takes in where the robot is, and how much the floor leans there [rad].
  void add(Stamp now, const mrpt::math::TPose2D& T_map_base, double slope = 0.0);
  /// The mapper corrected its past. Returns by how much the end of the trail moved [m], without limit when there is
  /// none.
  double follow(const slam::Mapper& mapper);

  const std::vector<mrpt::math::TPoint2D>& points() const { return points_; }
  /// Way along it [m].
  double length() const;
  /// The steepest slope it met near p_map [rad]; nothing where it was not (PassedFloor).
  std::optional<double> slope(const mrpt::math::TPoint2D& p_map) const { return passed_.slope(p_map); }

 private:
  std::vector<Anchor> anchors_;
  std::vector<mrpt::math::TPoint2D> points_;  ///< the anchors' places
  std::vector<double> slopes_;                ///< of the floor at them [rad]
  PassedFloor passed_;                        ///< these again
};

}  // namespace rubble::explore
