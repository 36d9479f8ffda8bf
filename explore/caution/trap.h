#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cmath>

#include "explore/anchor.h"

namespace rubble::explore {

/// A pallet full of steps that the robot is held on, kept relative to where it was held.
struct Trap {
  Anchor anchor;
  mrpt::math::TPose2D T_base_pallet;  ///< of the pallet's middle
  double size = 0.0;                  ///< [m]

  mrpt::math::TPose2D T_map_pallet() const { return anchor.T_map_base + T_base_pallet; }
  /// Whether a place is on it or within `beyond` of it [m].
  bool holds(const mrpt::math::TPoint2D& p_map, double beyond = 0.0) const {
    const mrpt::math::TPoint2D p = T_map_pallet().inverseComposePoint(p_map);
    const double half = 0.5 * size + beyond;
    return std::abs(p.x) <= half && std::abs(p.y) <= half;
  }
  /// The mapper corrected its past.
  void follow(const slam::Mapper& mapper) { anchor.follow(mapper); }
};

}  // namespace rubble::explore
