#include "explore/stuck/way_back.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/planar.h"
#include "explore/plan/path_follower.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPose2D;

constexpr double kLittleTurn = deg_to_rad(2.0);  ///< less is not turned [rad]
constexpr double kSamePose = 0.045;              ///< nearer the robot is where it was [m]
constexpr double kSameTurn = deg_to_rad(6.0);    ///< and turned alike [rad]
constexpr std::size_t kMost = 400;               ///< poses kept: some ten metres
constexpr double kBackSpeed = 0.2;               ///< [m/s]
constexpr double kTurnSpeed = deg_to_rad(45.0);  ///< [rad/s]
constexpr double kBackGain = 2.5;                ///< speed per way left [1/s]

double apart(const TPose2D& a, const TPose2D& b) { return distance(position(a), position(b)); }
double turned(const TPose2D& a, const TPose2D& b) { return std::abs(wrap_angle(a.phi - b.phi)); }
bool alike(const TPose2D& a, const TPose2D& b) {
  if (std::abs(a.x - b.x) > 2.0 * kSamePose) return false;  // for most of a long way this is all that is asked
  return apart(a, b) < kSamePose && turned(a, b) < kSameTurn;
}

/// A pose beside the robot, which slipped sideways meanwhile, cannot be driven to: one before it then.
bool leads_on(const TPose2D& from, const TPose2D& to) {
  return !alike(from, to) && (std::abs((to - from).x) > 0.5 * kSamePose || turned(from, to) > kLittleTurn);
}

}  // namespace

void WayBack::add(Stamp now, const TPose2D& T_map_base) {
  const auto before = std::find_if(way_.begin(), way_.end(),
                                   [&](const Anchor& anchor) { return alike(anchor.T_map_base, T_map_base); });
  if (before != way_.end()) {
    way_.erase(before + 1, way_.end());
    return;
  }
  way_.push_back({now, T_map_base});
  if (way_.size() > kMost) way_.erase(way_.begin());
}

void WayBack::follow(const slam::Mapper& mapper) {
  for (Anchor& anchor : way_) anchor.follow(mapper);
}

std::optional<robot::Drive> WayBack::drive(const TPose2D& T_map_base) const {
  const auto next = std::find_if(way_.rbegin(), way_.rend(),
                                 [&](const Anchor& anchor) { return leads_on(T_map_base, anchor.T_map_base); });
  if (next == way_.rend()) return std::nullopt;
  const TPose2D left = next->T_map_base - T_map_base;
  const double turn = wrap_angle(left.phi);
  const double w =
      std::abs(turn) < kLittleTurn ? 0.0 : std::copysign(std::max(kLeastTurn, kBackGain * std::abs(turn)), turn);
  return robot::Drive{std::clamp(kBackGain * left.x, -kBackSpeed, kBackSpeed), std::clamp(w, -kTurnSpeed, kTurnSpeed)};
}

}  // namespace rubble::explore
