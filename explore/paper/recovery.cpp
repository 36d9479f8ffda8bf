#include <algorithm>
#include <cmath>

#include "explore/paper/paper_explorer.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::Drive;

constexpr double kBarTime = 60.0;      ///< for the first failure; doubles with each one more [s]
constexpr double kSamePlace = 0.5;     ///< [m]
constexpr double kTurningRate = 0.15;  ///< [rad/s]
constexpr double kLean = 0.03;         ///< getting free, the body may come so much closer to walls [m]
constexpr int kMaxFailedEscapes = 10;  ///< in a row
constexpr double kPushReach = 1.0;     ///< things to be pushed aside are watched from here on [m]
constexpr double kWall = 0.08;         ///< a hit so near to something of the map that is not loose is on that [m]
constexpr double kRoll = 0.15;         ///< farther they do not roll between two looks [m]

}  // namespace

void PaperExplorer::check_path(const slam::Mapper& mapper) {
  if (!path_watch_.due(now_) || follower_.arrived() || looking_.active()) return;
  const std::vector<TPoint2D> hits = without_loose_things(mapper.last_hits());
  if (path_watch_.check(follower_, hits, pose_, commanded_.v, path_d_min_, now_)) plan_forced_ = true;
}

/// The hits but for those on things that are to be pushed aside. The map shows these where they lay; as they roll, what
/// is seen near where they were just now is they.
std::vector<TPoint2D> PaperExplorer::without_loose_things(const std::vector<TPoint2D>& hits) {
  const TPoint2D here = position(pose_);
  std::vector<TPoint2D> loose = std::move(rolling_);
  rolling_.clear();
  if (pushed_aside_ == 0.0) return hits;
  for (const Cell c : last_floor_.loose)
    if (const TPoint2D p = last_floor_.cells.centre(c); distance(p, here) < kPushReach) loose.push_back(p);
  std::vector<TPoint2D> rest;
  for (const TPoint2D& hit : hits) {
    const Cell c = last_floor_.clearance.cell(hit);
    const bool wall = last_floor_.clearance.inside(c) && last_floor_.clearance[c] < kWall;
    const bool rolls = !wall && distance(hit, here) < kPushReach &&
                       std::any_of(loose.begin(), loose.end(), [&](const auto& p) { return distance(p, hit) < kRoll; });
    (rolls ? rolling_ : rest).push_back(hit);
  }
  if (!rolling_.empty()) path_watch_.slow_down(now_);
  return rest;
}

/// Something holds the robot that the scanner cannot see: it is remembered, and the robot gets free of it.
void PaperExplorer::got_stuck(const std::string& how) {
  const bool rocking = watch_.rocking();
  // On its ramp the base would push on for a second, and every turn of the wheels in vain is a lie of the odometry.
  brakes_ = true;
  watch_.reset();
  tilt_.reset();
  looking_.end();
  follower_.clear();
  ++times_stuck_;
  const TPoint2D here = position(pose_);
  const bool again = stuck_place_ && distance(*stuck_place_, here) < kSamePlace;
  stuck_there_ = again ? stuck_there_ + 1 : 1;
  stuck_place_ = here;
  if (stuck_there_ > 1 && target_ && state_ != ExplorerState::GoingHome) bar_target(*target_);

  const bool turning = !rocking && std::abs(commanded_.v) <= Pivot::kMostSpeed && std::abs(commanded_.w) > kTurningRate;
  const Escape::Met met = jolt_.struck() ? (jolt_.from_ahead() ? Escape::Met::Forwards : Escape::Met::Backwards)
                          : rocking      ? Escape::Met::Forwards
                          : turning || commanded_.v == 0.0 ? Escape::Met::Turning
                          : commanded_.v > 0.0             ? Escape::Met::Forwards
                                                           : Escape::Met::Backwards;
  bool pallet = false;
  if (met != Escape::Met::Turning) {
    const auto grid =
        config_.felt.pallet > 0.0 ? find_pallets(last_floor_.cells, config_.felt.pallet, here) : std::nullopt;
    pallet = felt_.feel({now_, pose_}, met == Escape::Met::Backwards, model_, grid, trail_);
  }
  note(how + (pallet ? ": backs off and keeps clear of the pallet ahead" : ": backs off and plans around it"));
  escape_.begin(met, pose_, now_, failed_escapes_);
  after_escape_ = state_;
  state_ = ExplorerState::BackingUp;
}

Drive PaperExplorer::escape() {
  const auto room = [&](const TPose2D& T_map_base) {
    const double x = T_map_base.x, y = T_map_base.y;
    const Cell c = last_floor_.clearance.cell({x, y});
    return !last_floor_.clearance.inside(c) || last_floor_.clearance[c] > 0.5 * model_.width - kLean;
  };
  const Escape::Result result =
      escape_.step(pose_, commanded_, stalled_, jolt_.struck(), dt_, now_, trail_, way_back_, room);
  brakes_ = escape_.met();
  switch (result) {
    case Escape::Result::UnderWay:
      return escape_.drive();
    case Escape::Result::Free:
      failed_escapes_ = 0;
      break;
    case Escape::Result::Failed:
      note("could not get free");
      if (++failed_escapes_ >= kMaxFailedEscapes) {
        finish(MissionEnd::Stuck, "stuck");
        return {};
      }
      break;
  }
  watch_.reset();
  state_ = after_escape_;
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
  facing_ = false;
  follower_.clear();
}

}  // namespace rubble::explore
