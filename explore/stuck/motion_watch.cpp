#include "explore/stuck/motion_watch.h"

#include <algorithm>
#include <cmath>

#include "base/planar.h"

namespace rubble::explore {

void MotionWatch::reset() { *this = MotionWatch(config_); }

bool MotionWatch::stuck(const mrpt::math::TPose2D& T_map_base, const robot::Drive& commanded, bool stalled, double dt) {
  const bool moved = length(T_map_base.x - reference_.x, T_map_base.y - reference_.y) > config_.moved ||
                     std::abs(wrap_angle(T_map_base.phi - reference_.phi)) > config_.turned;
  if (!has_reference_) {
    place_ = T_map_base;
    last_phi_ = T_map_base.phi;
  }
  if (!has_reference_ || moved) {
    reference_ = T_map_base;
    has_reference_ = true;
    way_ = 0.0;
    turn_ = 0.0;
  }
  if (length(T_map_base.x - place_.x, T_map_base.y - place_.y) > config_.place) {
    place_ = T_map_base;
    rocked_ = net_ = pushed_ = 0.0;
  }
  net_ += wrap_angle(T_map_base.phi - last_phi_);
  last_phi_ = T_map_base.phi;
  rocked_ += std::abs(commanded.w) * dt;
  expected_ += std::clamp(commanded.v - expected_, -config_.accel * dt, config_.accel * dt);
  if (commanded.v * expected_ <= 0.0) expected_ = 0.0;
  if (!on_the_spot(commanded)) {
    way_ += std::abs(expected_) * dt;
    // Wheels that spin carry the pose on between two scans, and each scan puts it back: it trembles in its place.
    pushed_ += std::abs(expected_) * dt;
  }
  turn_ += std::abs(commanded.w) * dt;
  stalled_for_ = stalled ? stalled_for_ + dt : 0.0;
  return rocking() || way_ > config_.patience || pushed_ > config_.place_patience || turn_ > config_.turn_patience ||
         stalled_for_ > config_.stall_time;
}

}  // namespace rubble::explore
