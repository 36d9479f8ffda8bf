#include <algorithm>
#include <cmath>

#include "explore/paper/paper_explorer.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using robot::Drive;

constexpr double kBarTime = 60.0;  ///< for the first failure; doubles with each one more [s]
constexpr int kMaxStuckAtPlace = 6;

TPoint2D position(const mrpt::math::TPose2D& pose) { return {pose.x, pose.y}; }

}  // namespace

void PaperExplorer::check_path(const slam::Mapper& mapper) {
  if (!path_watch_.due(now_) || follower_.arrived() || looking_.active()) return;
  if (path_watch_.check(follower_, mapper.last_hits(), pose_, commanded_.v, path_d_min_, now_)) plan_forced_ = true;
}

void PaperExplorer::got_stuck() {
  watch_.reset();
  looking_.end();
  const TPoint2D here = position(pose_);
  const bool again = stuck_place_ && distance(*stuck_place_, here) < 0.5;
  stuck_there_ = again ? stuck_there_ + 1 : 1;
  stuck_place_ = here;
  if (stuck_there_ > 1 && target_) bar_target(*target_);
  if (stuck_there_ > kMaxStuckAtPlace) return finish("stuck");

  // Whatever holds the robot stands before it: something the scanner cannot see.
  std::vector<TPoint2D> felt;
  for (int i = -2; i <= 2; ++i) {
    const double ahead = 0.5 * model_.length + 0.10;
    const double aside = 0.1 * i;
    felt.push_back({pose_.x + ahead * std::cos(pose_.phi) - aside * std::sin(pose_.phi),
                    pose_.y + ahead * std::sin(pose_.phi) + aside * std::cos(pose_.phi)});
  }
  path_watch_.remember(felt, now_);
  const TPoint2D rear{pose_.x - 0.25 * std::cos(pose_.phi), pose_.y - 0.25 * std::sin(pose_.phi)};
  const Cell c = last_floor_.clearance.cell(rear);
  const bool rear_free = !last_floor_.clearance.inside(c) || last_floor_.clearance[c] > 0.5 * model_.width;
  const bool turns = commanded_.v < 0.0 || !rear_free || stuck_there_ % 3 == 0;
  const double side = stuck_there_ % 2 == 0 ? 1.0 : -1.0;
  backing_up_.begin(turns ? side * config_.follower.turn_speed : 0.0, now_);
  after_back_up_ = state_;
  state_ = ExplorerState::BackingUp;
}

Drive PaperExplorer::back_up() {
  if (const std::optional<Drive> drive = backing_up_.drive(now_)) return *drive;
  state_ = after_back_up_;
  plan_forced_ = true;
  return {};
}

void PaperExplorer::bar_target(const TPoint2D& where) {
  const int times = std::min(blacklist_.times_barred(where), 6);
  blacklist_.bar(where, kBarRadius, now_ + kBarTime * std::ldexp(1.0, times));
  target_.reset();
  plan_forced_ = true;
}

void PaperExplorer::look_around(double angle, bool to_the_end) {
  looking_.begin(angle, to_the_end, now_);
  follower_.clear();
}

}  // namespace rubble::explore
