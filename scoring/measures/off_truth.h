#pragma once

#include <mrpt/math/TPoint2D.h>

#include "base/grid.h"

namespace rubble::scoring {

constexpr double kSurvey = 0.5;  ///< what a map knows so near to the truth's known ground belongs to it [m]

/// How far places are from the ground that the truth knows.
class OffTruth {
 public:
  /// `reach`: further away it is infinite [m].
  OffTruth(const OccupancyGrid& truth, double reach);
  /// `p`: in the truth [m]. 0 on known ground.
  double operator()(const mrpt::math::TPoint2D& p) const;

 private:
  double reach_;
  Grid<float> away_;
};

}  // namespace rubble::scoring
