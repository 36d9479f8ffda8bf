#include "explore/motion/pilot.h"

#include <cmath>
#include <optional>
#include <utility>

namespace rubble::explore {
namespace {

constexpr double kCornerRoom = 0.13;  ///< beside corners that turn [m]

}  // namespace

Pilot::Pilot(const robot::RobotModel& model, const FollowerConfig& config)
    : follower_(model, config),
      watch_(model),
      turn_(model),
      pivot_(model.swing_radius() + kCornerRoom),
      corners_(model),
      slides_(model, robot::kRubberOnWood) {}

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
  leave_spot();
}

/// A turn on the spot stays on it, and its corners off the walls.
CornerRoom::Kept Pilot::kept(const robot::Drive& told, const Moment& robot, const Traversable& floor,
                             const std::vector<mrpt::math::TPoint2D>& hits, Stamp now) {
  const Anchor here{now, robot.T_map_base};
  const double left = std::abs(turning() ? turn_.left() : follower_.turn_left());
  const robot::Drive drive = pivot_.keep(told, here, floor, {slides_.across(robot.lean, 1.0), left});
  if (told.v == 0.0 && told.w != 0.0) return corners_.keep(drive, robot.moving, here, floor, hits);
  corners_.end();
  return {drive};
}

Pilot::Step Pilot::step(const Moment& robot, const Traversable& floor, const std::vector<mrpt::math::TPoint2D>& hits,
                        Stamp now) {
  if (turning()) {
    const std::optional<robot::Drive> drive = turn_.turn(robot.turned, follower_.turn_speed_on(robot.slope), now);
    const CornerRoom::Kept turn = kept(drive.value_or(robot::Drive{}), robot, floor, hits, now);
    return {turn.drive, turn.brakes, !drive, !drive && purpose_ == TurnFor::Place};
  }
  if (watch_.waits(now)) return {};
  const CornerRoom::Kept way = kept(follower_.drive(robot.T_map_base, robot.slope), robot, floor, hits, now);
  return {watch_.limited(way.drive, now), way.brakes};
}

}  // namespace rubble::explore
