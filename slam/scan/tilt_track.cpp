#include "slam/scan/tilt_track.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "robot/hardware_units.h"
#include "slam/scan/waiting_scans.h"

namespace rubble::slam {

namespace {

constexpr double kFarthest = 0.25;    ///< a sample this far from a stamp says nothing about it [s]
constexpr double kLongestWait = 0.2;  ///< for samples after a scan, and for the wheels after a sample [s]
constexpr double kSteepest = 0.6;     ///< a robot that leans more lies on its side, or its sensor is broken [rad]
constexpr double kImplausible = 2.0;  ///< more than so many g is no tilt but a fault

}  // namespace

void TiltTrack::add(const robot::Inputs& inputs) {
  const bool turned = !unit_.jammed_at();
  unit_.update(inputs);
  if (turned && unit_.jammed_at()) leans_.clear();  // what was taken for the body's was the servos'
  const auto stamped_well = [&](const auto& sample) { return sample.stamp - inputs.now <= kAhead; };
  for (const robot::Odometry& odometry : inputs.odometry)
    if (stamped_well(odometry) && std::isfinite(odometry.v) && std::isfinite(odometry.w) &&
        (wheels_.empty() || odometry.stamp > wheels_.back().stamp))
      wheels_.push_back(odometry);
  for (const robot::AimState& aim : inputs.aims)
    if (stamped_well(aim)) follow(aim);
  for (const robot::Acceleration& acceleration : inputs.accelerations)
    if (stamped_well(acceleration) && std::abs(acceleration.x) < kImplausible * robot::kGravity &&
        std::abs(acceleration.y) < kImplausible * robot::kGravity)
      waiting_.push_back(acceleration);
  const bool wheels_talk = !wheels_.empty() && inputs.now - wheels_.back().stamp <= kLongestWait;
  while (!waiting_.empty()) {
    if (wheels_talk && wheels_.back().stamp < waiting_.front().stamp) break;
    follow(waiting_.front());
    waiting_.pop_front();
  }
  // Whoever forgets by the clock of the wheels does not where these are silent.
  forget_before(inputs.now - kAhead - WaitingScans::kLateScan);
}

/// The servo follows its pulses.
void TiltTrack::follow(const robot::AimState& aim) {
  if (!std::isfinite(aim.pitch) || !std::isfinite(aim.roll)) return;
  if (aims_.empty()) {
    aims_.push_back(aim);
    return;
  }
  const robot::AimState& before = aims_.back();
  if (aim.stamp <= before.stamp) return;
  const double share = 1.0 - std::exp(-(aim.stamp - before.stamp) / robot::kServoTime);
  aims_.push_back(
      {aim.stamp, before.pitch + share * (aim.pitch - before.pitch), before.roll + share * (aim.roll - before.roll)});
}

void TiltTrack::follow(const robot::Acceleration& acceleration) {
  if (!leans_.empty() && acceleration.stamp <= leans_.back().stamp) return;
  const robot::Tilt felt = robot::felt_tilt(acceleration, place_, motion_at(acceleration.stamp));
  const robot::AimState aim = on_platform_ ? aim_at(acceleration.stamp) : robot::AimState{};
  Lean lean{acceleration.stamp, felt.pitch - aim.pitch, felt.roll - aim.roll};
  if (!leans_.empty() && acceleration.stamp - leans_.back().stamp <= robot::kTiltSilence) {
    const Lean& before = leans_.back();
    const double share = 1.0 - std::exp(-2.0 * kPi * config_.filter_hz * (acceleration.stamp - before.stamp));
    lean.pitch = before.pitch + share * (lean.pitch - before.pitch);
    lean.roll = before.roll + share * (lean.roll - before.roll);
  }
  leans_.push_back(lean);
}

/// Of the two odometries around a stamp, or the last two, which say nothing once they are too old.
robot::WheelMotion TiltTrack::motion_at(Stamp stamp) const {
  auto after = std::lower_bound(wheels_.begin(), wheels_.end(), stamp,
                                [](const robot::Odometry& o, Stamp s) { return o.stamp < s; });
  if (after == wheels_.end()) {
    if (wheels_.empty() || stamp - wheels_.back().stamp > robot::kTiltSilence) return {};
    --after;
  }
  if (after->stamp - stamp > robot::kTiltSilence) return {};
  return robot::wheel_motion(after == wheels_.begin() ? *after : *(after - 1), *after, stamp);
}

bool TiltTrack::ready(Stamp stamp, Stamp now) const {
  if (leans_.empty() && waiting_.empty()) return true;
  if (!leans_.empty() && leans_.back().stamp >= stamp + config_.lag) return true;
  const Stamp last = waiting_.empty() ? leans_.back().stamp : waiting_.back().stamp;
  return now - stamp > config_.lag + kLongestWait || now - last > kLongestWait;
}

bool TiltTrack::fell_silent(Stamp stamp) const {
  const Stamp late = stamp + config_.lag;
  const auto after =
      std::lower_bound(leans_.begin(), leans_.end(), late, [](const Lean& l, Stamp s) { return l.stamp < s; });
  return !leans_.empty() && std::abs((after == leans_.end() ? leans_.back() : *after).stamp - late) > kFarthest;
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
  return on_body(pitch, roll, stamp);
}

ScanTilt TiltTrack::on_body(double pitch, double roll, Stamp stamp) const {
  const robot::AimState aim = aim_at(stamp);
  return {pitch + aim.pitch, roll + aim.roll, pitch, roll};
}

/// Half a frame passes until a pulse is taken. The servos hold their last angle; zero while none is known.
robot::AimState TiltTrack::aim_at(Stamp stamp) const {
  if (const auto& held = unit_.jammed_at()) return {stamp, held->pitch, held->roll};
  const auto after = std::upper_bound(aims_.begin(), aims_.end(), stamp + -0.5 * robot::kServoFrame,
                                      [](Stamp s, const robot::AimState& aim) { return s < aim.stamp; });
  if (after == aims_.begin()) return aims_.empty() ? robot::AimState{} : aims_.front();
  return *(after - 1);
}

void TiltTrack::forget_before(Stamp oldest_needed) {
  const auto forget = [oldest_needed](auto& samples) {
    while (samples.size() > 2 && samples[1].stamp < oldest_needed) samples.pop_front();
  };
  forget(leans_);
  forget(aims_);
  forget(wheels_);
}

}  // namespace rubble::slam
