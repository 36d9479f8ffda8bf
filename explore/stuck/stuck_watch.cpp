#include "explore/stuck/stuck_watch.h"

#include <cmath>

namespace rubble::explore {
namespace {

constexpr double kHeld = 0.5;           ///< a tick so long: the robot was held, a device was away [s]
constexpr double kPatience = 2.0;       ///< then its motors may still be off for a while [s]
constexpr double kOdometryLate = 0.25;  ///< the wheels are silent [s]
constexpr double kPoseDoubted = 2.0;    ///< a pose that fell behind a moving robot may do so again for a while [s]
constexpr double kDrives = 0.15;        ///< a robot that turns and is slower only turns [m/s]

}  // namespace

void StuckWatch::update(const robot::Inputs& inputs, double passed, double dt) {
  if (passed > kHeld) {
    begin_anew();
    patient_until_ = inputs.now + kPatience;
  }
  if (!inputs.odometry.empty()) {
    stalled_ = inputs.odometry.back().stalled;
    // A base that never gives its speeds tells nothing of its wheels.
    const robot::Drive wheels{inputs.odometry.back().v, inputs.odometry.back().w};
    if (wheels_ || wheels.v != 0.0 || wheels.w != 0.0) wheels_ = wheels;
    odometry_at_ = inputs.now;
  }
  tilt_.update(inputs, dt);
  jolt_.update(inputs);
  brake_test_.update(inputs);
}

void StuckWatch::doubt_pose(Stamp now) {
  begin_anew();
  pose_doubted_until_ = now + kPoseDoubted;
}

std::optional<StuckWatch::Hold> StuckWatch::held(const mrpt::math::TPose2D& T_map_base, const robot::Drive& commanded,
                                                 bool on_purpose, double dt, Stamp now) {
  if (on_purpose) motion_.turns_on_purpose();
  // Nobody knows whether a base that is silent moves: a pulled plug is no obstacle.
  if (odometry_at_ && now - *odometry_at_ > kOdometryLate) {
    motion_.reset();
    slowed_.reset();
  }
  const bool stuck =
      motion_.stuck(T_map_base, now < patient_until_ ? robot::Drive{} : commanded, stalled_, dt, wheels_);
  // Wheels that are dragged aside as the body turns jolt it too.
  const bool turns_slowly =
      commanded.w != 0.0 && std::abs(commanded.v) < kDrives && wheels_ && std::abs(wheels_->v) < kDrives;
  const bool blow = jolt_.struck() && !turns_slowly;
  if (motion_.on_the_spot(commanded)) slowed_.reset();
  const bool slowed = slowed_.held(jolt_.shaken() && commanded.v != 0.0 && !turns_slowly, T_map_base,
                                   wheels_.value_or(commanded), tilt_.lean().pitch, dt, now);
  if (!tilt_.too_steep() && !blow && !slowed && !stuck) return std::nullopt;
  const bool by_motion = !tilt_.too_steep() && !blow && !slowed && !stalled_ && !motion_.rocking();
  const bool in_vain = by_motion && motion_.steers_in_vain();
  const bool by_pose = by_motion && !in_vain;
  const Escape::Met met = this->met(commanded);
  if (by_pose && met != Escape::Met::Turning && now < pose_doubted_until_) return std::nullopt;
  const Hold hold{tilt_.too_steep() ? "it leans too much here"
                  : blow            ? "a blow stops it"
                  : slowed          ? "a blow holds it back"
                  : stalled_        ? "the motors stall"
                                    : "it does not move",
                  met, by_pose, in_vain};
  begin_anew();
  pose_doubted_until_ = Stamp::never();  // it drove into something since
  tilt_.reset();
  return hold;
}

Escape::Met StuckWatch::met(const robot::Drive& commanded) const {
  if (jolt_.struck()) return jolt_.from_ahead() ? Escape::Met::Forwards : Escape::Met::Backwards;
  if (motion_.rocking()) return Escape::Met::Forwards;
  if (motion_.on_the_spot(commanded) || commanded.v == 0.0) return Escape::Met::Turning;
  return commanded.v > 0.0 ? Escape::Met::Forwards : Escape::Met::Backwards;
}

}  // namespace rubble::explore
