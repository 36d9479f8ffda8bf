#include "slam/scan/tilt_track.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "robot/hardware_units.h"

namespace rubble::slam {

namespace {

constexpr double kFarthest = 0.25;    ///< a sample this far from a stamp says nothing about it [s]
constexpr double kLongestWait = 0.2;  ///< for samples after a scan [s]
constexpr double kSteepest = 0.6;     ///< a robot that leans more lies on its side, or its sensor is broken [rad]
constexpr double kImplausible = 2.0;  ///< more than so many g is no tilt but a fault

}  // namespace

void TiltTrack::add(const robot::Inputs& inputs) {
  for (const robot::Odometry& odometry : inputs.odometry) follow(odometry);
  for (const robot::Acceleration& acceleration : inputs.accelerations) follow(acceleration);
  for (const robot::AimState& aim : inputs.aims)
    if (std::isfinite(aim.pitch) && std::isfinite(aim.roll) && (aims_.empty() || aim.stamp > aims_.back().stamp))
      aims_.push_back(aim);
}

void TiltTrack::follow(const robot::Odometry& odometry) {
  if (!std::isfinite(odometry.v) || !std::isfinite(odometry.w)) return;
  felt_.follow(odometry);
}

void TiltTrack::follow(const robot::Acceleration& acceleration) {
  if (!(std::abs(acceleration.x) < kImplausible * robot::kGravity &&
        std::abs(acceleration.y) < kImplausible * robot::kGravity))
    return;
  if (!leans_.empty() && acceleration.stamp <= leans_.back().stamp) return;
  const robot::Tilt tilt = felt_.of(acceleration);
  Lean lean{acceleration.stamp, tilt.pitch, tilt.roll};
  if (!leans_.empty() && acceleration.stamp - leans_.back().stamp <= robot::kTiltSilence) {
    const Lean& before = leans_.back();
    const double share = 1.0 - std::exp(-2.0 * kPi * config_.filter_hz * (acceleration.stamp - before.stamp));
    lean.pitch = before.pitch + share * (tilt.pitch - before.pitch);
    lean.roll = before.roll + share * (tilt.roll - before.roll);
  }
  leans_.push_back(lean);
}

bool TiltTrack::ready(Stamp stamp, Stamp now) const {
  if (leans_.empty() || leans_.back().stamp >= stamp + config_.lag) return true;
  return now - stamp > kLongestWait || now - leans_.back().stamp > kLongestWait;
}

std::optional<ScanTilt> TiltTrack::at(Stamp stamp) const {
  const Stamp late = stamp + config_.lag;
  auto after = std::lower_bound(leans_.begin(), leans_.end(), late, [](const Lean& l, Stamp s) { return l.stamp < s; });
  if (after == leans_.end()) {
    if (leans_.empty()) return std::nullopt;
    --after;
  }
  if (std::abs(after->stamp - late) > kFarthest) return std::nullopt;
  double pitch = after->pitch;
  double roll = after->roll;
  if (after != leans_.begin() && after->stamp > late) {
    const Lean& before = *(after - 1);
    const double u = (late - before.stamp) / (after->stamp - before.stamp);
    pitch = before.pitch + u * (pitch - before.pitch);
    roll = before.roll + u * (roll - before.roll);
  }
  if (std::max(std::abs(pitch), std::abs(roll)) > kSteepest) return std::nullopt;
  const robot::AimState aim = aim_at(stamp);
  return ScanTilt{pitch, roll, pitch - aim.pitch, roll - aim.roll};
}

/// The servos hold their last angle; zero while none is known.
robot::AimState TiltTrack::aim_at(Stamp stamp) const {
  const auto after = std::upper_bound(aims_.begin(), aims_.end(), stamp,
                                      [](Stamp s, const robot::AimState& aim) { return s < aim.stamp; });
  if (after == aims_.begin()) return aims_.empty() ? robot::AimState{} : aims_.front();
  return *(after - 1);
}

void TiltTrack::forget_before(Stamp oldest_needed) {
  while (leans_.size() > 2 && leans_[1].stamp < oldest_needed) leans_.pop_front();
  while (aims_.size() > 2 && aims_[1].stamp < oldest_needed) aims_.pop_front();
}

}  // namespace rubble::slam
