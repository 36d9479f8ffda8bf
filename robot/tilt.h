#pragma once

#include <cmath>

namespace rubble::robot {

/// How something is inclined against the horizontal.
struct Tilt {
  double pitch = 0.0;  ///< nose-up positive [rad]
  double roll = 0.0;   ///< left side up positive [rad]
};

/// How steep it is, whichever way [rad], for angles up to some 20 deg.
inline double slope(const Tilt& tilt) { return std::hypot(tilt.pitch, tilt.roll); }

}  // namespace rubble::robot
