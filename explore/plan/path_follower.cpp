#include "explore/plan/path_follower.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/planar.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::Drive;

constexpr double kCurvatureSpan = 0.20;     ///< the path's direction is taken over this length on either side [m]
constexpr double kEndSpeed = 0.10;          ///< [m/s]
constexpr double kFlat = deg_to_rad(3.0);   ///< slopes up to this are none [rad]
constexpr double kSteep = deg_to_rad(9.0);  ///< from here on slope_speed holds: ramps of arenas have 10 deg [rad]

double direction(const TPoint2D& from, const TPoint2D& to) { return std::atan2(to.y - from.y, to.x - from.x); }

/// Linear from `low` at x <= x_low to `high` at x >= x_high.
double ramp(double x, double x_low, double x_high, double low, double high) {
  return low + (high - low) * std::clamp((x - x_low) / (x_high - x_low), 0.0, 1.0);
}

}  // namespace

PathFollower::PathFollower(const robot::RobotModel& model, const FollowerConfig& config)
    : config_(config), brake_(0.8 * model.max_accel), turn_brake_(0.6 * model.max_turn_accel) {
  config_.cruise_speed = std::min(config_.cruise_speed, model.max_v);
  config_.turn_speed = std::min(config_.turn_speed, model.max_w);
  config_.slope_turn = std::min(config_.slope_turn, config_.turn_speed);
  config_.passed_speed =
      std::clamp(config_.passed_speed, config_.cruise_speed, std::max(model.max_v, config_.cruise_speed));
  config_.rough_speed = std::min(config_.rough_speed, config_.cruise_speed);
  config_.slope_speed = std::min(config_.slope_speed, config_.passed_speed);
  config_.slow_speed = std::min(config_.slow_speed, config_.cruise_speed);
}

void PathFollower::set_path(std::vector<PathPoint> path) {
  path_ = std::move(path);
  progress_ = 0;
  way_.assign(path_.size(), 0.0);
  for (std::size_t i = 1; i < path_.size(); ++i) way_[i] = way_[i - 1] + distance(path_[i - 1].p_map, path_[i].p_map);
  plan_speeds();
}

/// Clearance and curvature limit each point; a backward pass makes every limit reachable by braking.
void PathFollower::plan_speeds() {
  speed_.assign(path_.size(), 0.0);
  std::size_t before = 0;
  std::size_t after = 0;
  for (std::size_t i = 0; i < path_.size(); ++i) {
    while (way_[i] - way_[before] > kCurvatureSpan) ++before;
    while (after + 1 < path_.size() && way_[after] - way_[i] < kCurvatureSpan) ++after;
    const double full = path_[i].ground == Ground::Passed  ? config_.passed_speed
                        : path_[i].ground == Ground::Rough ? config_.rough_speed
                                                           : config_.cruise_speed;
    speed_[i] =
        std::min(ramp(path_[i].clearance, config_.slow_clearance, config_.full_clearance, config_.slow_speed, full),
                 speed_on(path_[i].slope));
    if (before == i || after == i) continue;
    const double turn = std::abs(
        wrap_angle(direction(path_[i].p_map, path_[after].p_map) - direction(path_[before].p_map, path_[i].p_map)));
    const double curvature = turn / (0.5 * (way_[after] - way_[before]));
    if (curvature * speed_[i] > config_.turn_speed) speed_[i] = config_.turn_speed / curvature;
  }
  if (!speed_.empty()) speed_.back() = std::min(speed_.back(), kEndSpeed);
  for (std::size_t i = path_.size(); i-- > 1;)
    speed_[i - 1] = std::min(speed_[i - 1], std::sqrt(speed_[i] * speed_[i] + 2.0 * brake_ * (way_[i] - way_[i - 1])));
}

/// The highest speed on a slope: from ramp to ramp the laser's platform has to follow, and the wheels slip more.
double PathFollower::speed_on(double slope) const {
  return ramp(slope, kFlat, kSteep, config_.passed_speed, config_.slope_speed);
}

/// From 85 deg/s it turns on by 60 deg before it stands; beside a wall to which it slides that is too much.
double PathFollower::turn_speed_on(double slope) const {
  return ramp(slope, kFlat, kSteep, config_.turn_speed, config_.slope_turn);
}

double PathFollower::left() const { return path_.empty() ? 0.0 : way_.back() - way_[progress_]; }

/// Moves on to the nearest point within the next metre; never back, so that a path may come near itself.
void PathFollower::advance(const TPoint2D& p_map) {
  std::size_t nearest = progress_;
  for (std::size_t i = progress_; i < path_.size() && way_[i] - way_[progress_] < 1.0; ++i)
    if (distance(path_[i].p_map, p_map) < distance(path_[nearest].p_map, p_map)) nearest = i;
  progress_ = nearest;
}

TPoint2D PathFollower::aim_point(const TPoint2D& p_map) const {
  for (std::size_t i = progress_; i < path_.size(); ++i)
    if (distance(path_[i].p_map, p_map) >= config_.look_ahead) return path_[i].p_map;
  return path_.back().p_map;
}

Drive PathFollower::drive(const TPose2D& T_map_base, double slope) {
  const TPoint2D p_map{T_map_base.x, T_map_base.y};
  if (!path_.empty()) advance(p_map);
  turn_left_ = 0.0;
  if (arrived()) return {};

  const TPoint2D aim = aim_point(p_map);
  const double error = wrap_angle(direction(p_map, aim) - T_map_base.phi);
  turning_ = std::abs(error) > (turning_ ? config_.turn_done : config_.turn_in_place);
  if (turning_) {
    turn_left_ = error;
    return turn_on_the_spot(error, turn_speed_on(slope), turn_brake_);
  }

  const double curvature = 2.0 * std::sin(error) / std::max(distance(p_map, aim), 0.5 * config_.look_ahead);
  // Off the path's direction the speed profile does not hold: slower.
  double v = std::min(speed_[progress_], speed_on(slope)) *
             ramp(std::abs(error), 0.5 * config_.turn_in_place, config_.turn_in_place, 1.0, 0.5);
  if (std::abs(v * curvature) > config_.turn_speed) v = config_.turn_speed / std::abs(curvature);
  return {v, v * curvature};
}

Drive turn_on_the_spot(double angle, double turn_speed, double turn_brake) {
  const double w = std::min(turn_speed, std::max(kLeastTurn, std::sqrt(2.0 * turn_brake * std::abs(angle))));
  return {0.0, std::copysign(w, angle)};
}

int hits_on_path(const std::vector<PathPoint>& path, std::size_t from, double ahead, double radius,
                 const std::vector<TPoint2D>& hits, const TPose2D& T_map_base, const robot::RobotModel& model) {
  std::vector<TPoint2D> next;
  double way = 0.0;
  for (std::size_t i = from; i < path.size() && way <= ahead; ++i) {
    next.push_back(path[i].p_map);
    if (i + 1 < path.size()) way += distance(path[i].p_map, path[i + 1].p_map);
  }
  const double cos_phi = std::cos(T_map_base.phi);
  const double sin_phi = std::sin(T_map_base.phi);
  const double far = ahead + radius + distance(next.empty() ? TPoint2D{} : next.front(), {T_map_base.x, T_map_base.y});
  int count = 0;
  for (const TPoint2D& hit : hits) {
    const double dx = hit.x - T_map_base.x;
    const double dy = hit.y - T_map_base.y;
    if (std::abs(dx) > far || std::abs(dy) > far) continue;
    const bool inside_body = std::abs(cos_phi * dx + sin_phi * dy) < 0.5 * model.length &&
                             std::abs(cos_phi * dy - sin_phi * dx) < 0.5 * model.width;
    if (inside_body) continue;
    // Only what the robot would come closer to: a wall beside it that it drives away from is no obstacle.
    const double limit = std::min(radius, length(dx, dy) - 0.01);
    const bool near =
        std::any_of(next.begin(), next.end(), [&](const TPoint2D& p) { return distance(p, hit) < limit; });
    if (near) ++count;
  }
  return count;
}

}  // namespace rubble::explore
