#include "explore/caution/tilt_watch.h"

#include <algorithm>
#include <cmath>

#include "base/planar.h"

namespace rubble::explore {

void TiltWatch::update(const robot::Inputs& inputs, double dt) {
  if (!inputs.aims.empty()) {
    const double share = std::min(1.0, dt / config_.smoothing);
    pitch_ += share * (-inputs.aims.back().pitch - pitch_);
    roll_ += share * (-inputs.aims.back().roll - roll_);
  }
  steep_for_ = slope() > config_.too_steep ? steep_for_ + dt : 0.0;
}

double TiltWatch::slope() const { return length(pitch_, roll_); }

}  // namespace rubble::explore
