#pragma once

#include <cmath>

namespace rubble {

constexpr double kPi = 3.14159265358979323846;

constexpr double deg_to_rad(double deg) { return deg * (kPi / 180.0); }
constexpr double rad_to_deg(double rad) { return rad * (180.0 / kPi); }

/// Wraps an angle to (-pi, pi].
inline double wrap_angle(double a) {
  if (std::abs(a) <= kPi) return a <= -kPi ? kPi : a;
  a = std::remainder(a, 2.0 * kPi);
  return a <= -kPi ? a + 2.0 * kPi : a;
}

}  // namespace rubble
