#pragma once

namespace rubble::robot {

/// How something is inclined against the horizontal.
struct Tilt {
  double pitch = 0.0;  ///< nose-up positive [rad]
  double roll = 0.0;   ///< left side up positive [rad]
};

}  // namespace rubble::robot
