#include "sim/body/servos.h"

#include <algorithm>
#include <cmath>

namespace rubble::sim {

void Servo::command(double angle) {
  const double travel = std::clamp(angle, -parameters_.max_angle, parameters_.max_angle);
  commanded_ = std::round(travel / parameters_.pulse_step) * parameters_.pulse_step;
}

double Servo::target() const {
  return std::clamp(parameters_.scale * latched_ + parameters_.centre_offset, -parameters_.max_angle,
                    parameters_.max_angle);
}

/// Nothing new is commanded, the motor rests in its dead band and the play of the gears is taken up.
bool Servo::is_settled() const {
  return started_ && latched_ == commanded_ && std::abs(target() - gear_) < parameters_.dead_band &&
         std::abs(horn_ - gear_) <= 0.5 * parameters_.backlash;
}

void Servo::step(int milliseconds) {
  const int frame = static_cast<int>(std::lround(parameters_.frame * 1e3));
  if (is_settled()) {
    frame_ms_ = (frame_ms_ + milliseconds) % frame;
    return;
  }
  for (int i = 0; i < milliseconds; ++i) {
    if (!started_ || ++frame_ms_ >= frame) {
      latched_ = commanded_;
      frame_ms_ = 0;
      started_ = true;
    }
    if (jammed_) continue;
    const double error = target() - gear_;
    if (std::abs(error) >= parameters_.dead_band) {
      gear_ += 1e-3 * std::clamp(error / parameters_.response, -parameters_.max_rate, parameters_.max_rate);
    }
    horn_ = std::clamp(horn_, gear_ - 0.5 * parameters_.backlash, gear_ + 0.5 * parameters_.backlash);
  }
}

void Servos::command(const robot::LaserAim& aim) {
  pitch_.command(aim.pitch);
  roll_.command(aim.roll);
}

void Servos::step(int milliseconds) {
  pitch_.step(milliseconds);
  roll_.step(milliseconds);
}

}  // namespace rubble::sim
