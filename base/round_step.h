#pragma once

#include <cmath>

namespace rubble {

/// The least number from `least` (above 0) up that is 1, 2 or 5 times a power of ten: a step between an axis' ticks.
inline double round_step(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double times : {1.0, 2.0, 5.0})
    if (times * power >= least) return times * power;
  return 10.0 * power;
}

}  // namespace rubble
