#pragma once

#include <mrpt/math/TPose2D.h>

namespace rubble::slam {

/// What ties wheels and scanner together: the numbers that a calibration looks for.
struct RobotSetup {
  double distance_scale = 1.0;       ///< true distance per recorded distance
  double turn_scale = 1.0;           ///< true turn per recorded turn
  mrpt::math::TPose2D T_base_laser;  ///< seen from above; the base's origin is what it turns about on the spot
  double delay = 0.0;                ///< scans are so much older, by the odometry's clock, than their stamps say [s]
};

}  // namespace rubble::slam
