#pragma once

#include <mrpt/math/TPose2D.h>

#include "base/pose_covariance.h"

namespace rubble::explore {

/// Whether the pose has become doubtful where the robot is. A covariance counts from the map's origin, and far from it
/// a map that is right to centimetres may stand half a metre off as a whole: what is anchored to the robot's poses does
/// not mind. So the pose is held against an earlier one, moved to the place of today as if the way between had no
/// error; what it has lost against that is doubt, but for a little that is forgiven each second.
class PoseDoubt {
 public:
  /// The pose after a tick of `dt` [s], and its covariance in the map frame; zero (not estimated) is never doubtful.
  void update(const mrpt::math::TPose2D& T_map_base, const PoseCovariance& covariance, double dt);

  /// What the position has lost beyond the usual [m^2], sum of the variances along x and y.
  double lost() const { return lost_; }
  /// By so much that what is seen now cannot be placed.
  bool unsure() const;

 private:
  mrpt::math::TPose2D reference_;  ///< the last pose that had not lost more than usual: the map's origin at first
  PoseCovariance covariance_;      ///< of it
  double usual_ = 0.0;             ///< loss since then that is no doubt [m^2]
  double lost_ = 0.0;
};

}  // namespace rubble::explore
