#pragma once

#include <mrpt/math/TPoint2D.h>

#include <optional>
#include <vector>

#include "base/grid.h"

namespace rubble::scoring {

/// Centres of the occupied cells [m], row by row.
std::vector<mrpt::math::TPoint2D> wall_points(const OccupancyGrid& grid);

/// Distance to the nearest wall of one map, at any point of the plane.
class WallField {
 public:
  /// Distances are cut off at `cap` [m].
  WallField(const OccupancyGrid& grid, double cap);

  double cap() const { return cap_; }
  bool empty() const { return distance_.cells().empty(); }
  /// Bilinear between cell centres; exact at them; `cap` beyond reach of every wall.
  double distance(const mrpt::math::TPoint2D& p) const;
  /// Distance and its gradient.
  struct Slope {
    double distance = 0.0;
    double gx = 0.0;
    double gy = 0.0;
  };
  Slope slope(const mrpt::math::TPoint2D& p) const;

 private:
  double cap_;
  Grid<float> distance_;  // the walls' bounding box and `cap` around it
};

}  // namespace rubble::scoring
