#include "explore/motion/pilot.h"

#include <optional>
#include <utility>

namespace rubble::explore {
namespace {

constexpr double kCornerRoom = 0.13;  ///< beside corners that turn [m]

}  // namespace

Pilot::Pilot(const robot::RobotModel& model, const FollowerConfig& config)
    : follower_(model, config),
      watch_(model),
      turn_(model, config.turn_speed),
      pivot_(model.swing_radius() + kCornerRoom) {}

void Pilot::turn(double angle, TurnFor purpose, Stamp now) {
  turn_.begin(angle, now);
  purpose_ = purpose;
  follower_.clear();
}

void Pilot::follow(Plan plan) {
  if (purpose_ == TurnFor::View) turn_.end();
  watch_.unblock();
  d_min_ = plan.d_min;
  follower_.set_path(std::move(plan.path));
}

void Pilot::stop() {
  follower_.clear();
  turn_.end();
}

Pilot::Step Pilot::step(const mrpt::math::TPose2D& T_map_base, double turned, const Traversable& floor, Stamp now) {
  if (turning()) {
    const std::optional<robot::Drive> drive = turn_.turn(turned, now);
    return {pivot_.keep(drive.value_or(robot::Drive{}), T_map_base, floor), !drive,
            !drive && purpose_ == TurnFor::Place};
  }
  if (watch_.waits(now)) return {};
  return {watch_.limited(pivot_.keep(follower_.drive(T_map_base), T_map_base, floor), now)};
}

}  // namespace rubble::explore
