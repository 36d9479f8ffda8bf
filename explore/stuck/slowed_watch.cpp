#include "explore/stuck/slowed_watch.h"

#include <cmath>

#include "base/planar.h"

namespace rubble::explore {

bool SlowedWatch::held(bool shaken, const mrpt::math::TPose2D& T_map_base, const robot::Drive& wheels, double pitch,
                       double dt, Stamp now) {
  const double step = distance(position(last_), position(T_map_base));
  last_ = T_map_base;
  if (step > config_.jump + config_.scan_time * std::abs(wheels.v)) since_.reset();
  if (shaken && !since_) {
    since_ = Since{now, T_map_base, pitch};
    return false;
  }
  if (!since_) return false;
  since_->way += std::abs(wheels.v) * dt;
  since_->turn += wheels.w * dt;
  const double age = now - since_->at;
  if (age > config_.latest || std::abs(pitch - since_->pitch) > config_.crest) {
    since_.reset();
    return false;
  }
  if (age < config_.soonest || since_->way < config_.least_way) return false;
  const double moved = distance(position(since_->T_map_base), position(T_map_base));
  const double aside = wrap_angle(T_map_base.phi - since_->T_map_base.phi - since_->turn);
  return moved < config_.moved * since_->way || std::abs(aside) > config_.aside + config_.slip * std::abs(since_->turn);
}

}  // namespace rubble::explore
