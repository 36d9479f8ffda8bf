#include <algorithm>
#include <cmath>
#include <iterator>

#include "explore/explorer_impl.h"

namespace rubble::explore {
namespace {

constexpr double kCheckPeriod = 0.2;   ///< fresh hits are held against the path this often [s]
constexpr int kBlockingHits = 3;       ///< fewer may be noise
constexpr double kHitMemory = 10.0;    ///< hits that blocked the path count as obstacles this long [s]
constexpr double kHitReach = 1.5;      ///< hits farther away are not remembered [m]
constexpr double kBackUpTime = 1.0;    ///< [s]
constexpr double kBackUpSpeed = 0.2;   ///< [m/s]
constexpr double kBarTime = 60.0;      ///< for the first failure; doubles with each one more [s]
constexpr double kLookTimeout = 12.0;  ///< [s]
constexpr int kMaxStuckAtPlace = 6;

}  // namespace

/// Holds the newest hits against the path: things that moved, or that the map does not show yet.
void Explorer::Impl::check_path(const slam::Mapper& mapper) {
  if (now < next_check) return;
  next_check = now + kCheckPeriod;
  if (follower.arrived() || looking.active()) return;
  const double brake_way = commanded.v * commanded.v / (2.0 * model.max_accel);
  const double radius = std::min(0.5 * model.width + 0.03, path_d_min - 0.04);
  const std::vector<TPoint2D>& hits = mapper.last_hits();
  blocked =
      hits_on_path(follower.path(), follower.progress(), 0.5 + brake_way, radius, hits, pose, model) >= kBlockingHits;
  if (!blocked || now < creep_until) return;
  remembered_hits.clear();
  std::copy_if(hits.begin(), hits.end(), std::back_inserter(remembered_hits),
               [&](const TPoint2D& p) { return distance(p, position(pose)) < kHitReach; });
  forget_hits = now + kHitMemory;
  plan_forced = true;
}

void Explorer::Impl::got_stuck() {
  watch.reset();
  looking = {};
  const TPoint2D here = position(pose);
  const bool again = stuck_place && distance(*stuck_place, here) < 0.5;
  stuck_there = again ? stuck_there + 1 : 1;
  stuck_place = here;
  if (stuck_there > 1 && target) bar_target(*target);
  if (stuck_there > kMaxStuckAtPlace) return finish("stuck");

  // Whatever holds the robot stands before it: something the scanner cannot see.
  for (int i = -2; i <= 2; ++i) {
    const double ahead = 0.5 * model.length + 0.10;
    const double aside = 0.1 * i;
    remembered_hits.push_back({pose.x + ahead * std::cos(pose.phi) - aside * std::sin(pose.phi),
                               pose.y + ahead * std::sin(pose.phi) + aside * std::cos(pose.phi)});
  }
  forget_hits = now + kHitMemory;
  const TPoint2D rear{pose.x - 0.25 * std::cos(pose.phi), pose.y - 0.25 * std::sin(pose.phi)};
  const Cell c = last_floor.clearance.cell(rear);
  const bool rear_free = !last_floor.clearance.inside(c) || last_floor.clearance[c] > 0.5 * model.width;
  back_up_turns = commanded.v < 0.0 || !rear_free || stuck_there % 3 == 0;
  after_back_up = state;
  back_up_until = now + kBackUpTime;
  state = ExplorerState::BackingUp;
}

Drive Explorer::Impl::back_up() {
  if (now < back_up_until) {
    const double side = stuck_there % 2 == 0 ? 1.0 : -1.0;
    return back_up_turns ? Drive{0.0, side * config.turn_speed} : Drive{-kBackUpSpeed, 0.0};
  }
  state = after_back_up;
  plan_forced = true;
  return {};
}

void Explorer::Impl::bar_target(const TPoint2D& where) {
  const int times = std::min(blacklist.times_barred(where), 6);
  blacklist.bar(where, kBarRadius, now + kBarTime * std::ldexp(1.0, times));
  target.reset();
  plan_forced = true;
}

void Explorer::Impl::look_around(double angle, bool to_the_end) {
  looking = {angle, now + kLookTimeout, to_the_end};
  follower.clear();
}

Drive Explorer::Impl::look() {
  const bool was_positive = looking.left > 0.0;
  looking.left -= turned;
  if (was_positive != (looking.left > 0.0) || std::abs(looking.left) < deg_to_rad(5.0) || now >= looking.until) {
    looking = {};
    plan_forced = true;
    return {};
  }
  return turn_on_the_spot(looking.left, config.turn_speed, 0.6 * model.max_turn_accel);
}

}  // namespace rubble::explore
