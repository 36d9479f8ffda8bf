#include "explore/stuck/motion_watch.h"

#include <algorithm>
#include <cmath>

#include "base/planar.h"

namespace rubble::explore {

void MotionWatch::reset() { *this = MotionWatch(config_); }

/// The robot has hardly moved over the last piece of way that was commanded, or is turned aside on it.
bool MotionWatch::drives_in_vain(const mrpt::math::TPose2D& T_map_base) {
  // Of moments at the same way the last is asked: wheels that stand add none.
  if (!lately_.empty() && lately_.back().way == way_) lately_.pop_back();
  lately_.push_back({T_map_base, way_, wheel_turn_});
  while (lately_.size() > 1 && way_ - lately_[1].way >= config_.patience) lately_.pop_front();
  const auto since = [&](double way) {
    return std::find_if(lately_.rbegin(), lately_.rend(), [&](const Moment& then) { return way_ - then.way >= way; });
  };
  const auto soon = since(config_.soon), patient = since(config_.patience);
  return (soon != lately_.rend() && in_vain_since(*soon, T_map_base, config_.hardly)) ||
         (patient != lately_.rend() && in_vain_since(*patient, T_map_base, config_.moved));
}

bool MotionWatch::in_vain_since(const Moment& then, const mrpt::math::TPose2D& T_map_base, double share) const {
  const double way = way_ - then.way;
  const double moved = distance(position(then.T_map_base), position(T_map_base));
  // On a ramp the wheels slip and the body turns less than they do: that is no sign.
  const double wheels = wheel_turn_ - then.turn;
  const double body = wrap_angle(T_map_base.phi - then.T_map_base.phi);
  const double aside = std::abs(body) - (body * wheels > 0.0 ? std::abs(wheels) : 0.0);
  return moved < share * way || (moved < config_.led * way && aside > config_.aside);
}

bool MotionWatch::stuck(const mrpt::math::TPose2D& T_map_base, const robot::Drive& commanded, bool stalled, double dt,
                        const std::optional<robot::Drive>& wheels) {
  if (!has_reference_) {
    expected_ = wheels ? wheels->v : 0.0;
    place_ = T_map_base;
    last_ = T_map_base;
    steered_from_ = T_map_base.phi;
  }
  if (!has_reference_ || std::abs(wrap_angle(T_map_base.phi - reference_.phi)) > config_.turned) {
    reference_ = T_map_base;
    has_reference_ = true;
    turn_ = spun_ = rolled_ = 0.0;
  }
  if (length(T_map_base.x - place_.x, T_map_base.y - place_.y) > config_.place) {
    place_ = T_map_base;
    rocked_ = net_ = pushed_ = turn_ = rolled_ = 0.0;
  }
  const double turned_in_tick = wrap_angle(T_map_base.phi - last_.phi);
  const double moved_in_tick = distance(position(last_), position(T_map_base));
  net_ += turned_in_tick;
  last_ = T_map_base;
  // Wheels that stand and report no stall do not push: the base does not obey, and nothing is in the way. Not for ever,
  // for there may be bases that do not know of stalls.
  const bool stand = wheels && std::abs(wheels->v) < config_.standing && std::abs(wheels->w) < config_.standing;
  const bool told = commanded.v != 0.0 || commanded.w != 0.0;
  stood_for_ = stand && told ? stood_for_ + dt : 0.0;
  const bool by_wheels = wheels && stood_for_ < config_.disobedience;
  const double turning = by_wheels ? std::min(std::abs(commanded.w), std::abs(wheels->w)) : std::abs(commanded.w);
  rocked_ += turning * dt;
  expected_ += std::clamp(commanded.v - expected_, -config_.accel * dt, config_.accel * dt);
  // A base that brakes is ahead of that.
  if (wheels && std::abs(commanded.v - wheels->v) < std::abs(commanded.v - expected_)) expected_ = wheels->v;
  // A mapper that slid along bare walls puts the robot back where it was a second ago.
  if (moved_in_tick > config_.jump + config_.scan_time * std::abs(expected_)) lately_.clear();
  bool in_vain = false;
  if (on_the_spot(commanded) || commanded.v * expected_ <= 0.0) {
    lately_.clear();
  } else {
    const double driven = by_wheels ? std::min(std::abs(expected_), std::abs(wheels->v)) : std::abs(expected_);
    way_ += driven * dt;
    // Where nobody knows what the wheels do, all of the turn counts as theirs.
    wheel_turn_ += wheels ? wheels->w * dt : turned_in_tick;
    in_vain = drives_in_vain(T_map_base);
    // Wheels that spin carry the pose on between two scans, and each scan puts it back: it trembles in its place.
    pushed_ += driven * dt;
  }
  // The scans tell the heading also where the walls look the same all along and nobody knows how far it came.
  steered_ += wheels && !on_the_spot(commanded) ? wheels->w * dt : 0.0;
  if (std::abs(wrap_angle(T_map_base.phi - steered_from_)) > config_.unmoved) {
    steered_ = 0.0;
    steered_from_ = T_map_base.phi;
  }
  // A slow curve turns the robot less than it is told where the floor holds it back: its way is judged, not its turn.
  turn_ += on_the_spot(commanded) ? turning * dt : 0.0;
  spun_ += on_the_spot(commanded) && wheels ? wheels->w * dt : 0.0;
  // Told to drive a little as it turns, a robot that is held may roll its wheels only.
  rolled_ += on_the_spot(commanded) && wheels ? std::abs(wheels->v) * dt : 0.0;
  stalled_for_ = stalled ? stalled_for_ + dt : 0.0;
  return rocking() || in_vain || steers_in_vain() || pushed_ > config_.place_patience ||
         turn_ > config_.turn_patience || std::abs(spun_) > config_.turn_patience || rolled_ > config_.rolled ||
         stalled_for_ > config_.stall_time;
}

}  // namespace rubble::explore
