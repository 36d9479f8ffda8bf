#include "explore/stuck/tilt_watch.h"

#include <algorithm>
#include <cmath>

#include "base/planar.h"

namespace rubble::explore {

void TiltWatch::update(const robot::Inputs& inputs, double dt) {
  const double share = std::min(1.0, dt / config_.smoothing);
  const bool told = !inputs.aims.empty() && !distrusted_;
  silent_for_ = told ? 0.0 : silent_for_ + dt;
  if (told) {
    lean_.pitch += share * (-inputs.aims.back().pitch - lean_.pitch);
    lean_.roll += share * (-inputs.aims.back().roll - lean_.roll);
  } else if (silent_for_ > config_.silence) {
    lean_.pitch -= share * lean_.pitch;
    lean_.roll -= share * lean_.roll;
  }
  steep_for_ = slope() > config_.too_steep ? steep_for_ + dt : 0.0;
}

double TiltWatch::slope() const { return robot::slope(lean_); }

}  // namespace rubble::explore
