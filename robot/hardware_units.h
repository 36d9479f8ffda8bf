#pragma once

#include <cmath>

#include "base/angle.h"

namespace rubble::robot {

// What the hardware counts in, for drivers, emulators and the simulator alike.

constexpr double kMillimetre = 1e-3;                    ///< [m]
constexpr double kArcosHeadingUnit = 2.0 * kPi / 4096;  ///< THPOS of ARCOS' reports [rad]
constexpr double kServoStep = deg_to_rad(0.09);         ///< a servo's turn per microsecond of its pulse [rad]
constexpr double kServoFrame = 0.02;                    ///< a servo takes a new pulse each so often [s]
constexpr double kServoTime = 0.04;                     ///< and goes there with this time constant [s]
constexpr double kGravity = 9.80665;                    ///< standard gravity [m/s^2]

/// In whole units.
inline int rounded(double value) { return static_cast<int>(std::lround(value)); }

}  // namespace rubble::robot
