#include "robot/levelling_watch.h"

#include <algorithm>
#include <cmath>

namespace rubble::robot {
namespace {

constexpr double kSilence = 1.0;                ///< without a word for so long it has failed [s]
constexpr double kTiltFilter = 0.2;             ///< time constant [s]
constexpr double kLevel = deg_to_rad(1.5);      ///< what levelling leaves where nothing moves
constexpr double kLevelFor = 0.5;               ///< where it is level it stays so; one that brakes swings through [s]
constexpr double kLeans = deg_to_rad(20.0);     ///< no robot stands so for long: aims beyond are of servos in vain
constexpr double kLeansFor = 8.0;               ///< levelled at such an aim for so long [s]
constexpr double kTilted = deg_to_rad(3.0);     ///< what it never leaves ...
constexpr double kAimedFar = deg_to_rad(15.0);  ///< ... of a tilt it turned so far against ...
constexpr double kLevelledFor = 1.5;            ///< ... for longer than servos and loop take [s]
constexpr double kAtStopFor = 2.2;  ///< where they can turn no farther, longer than a robot stays so steep [s]
constexpr double kTakenAway = deg_to_rad(0.5);  ///< a tilt that shrinks by so much meanwhile is being levelled
constexpr double kAtStop = deg_to_rad(1.0);     ///< servos so near to the end of their travel are there

bool is_silent(Stamp last, Stamp now) { return last != Stamp::never() && now - last > kSilence; }

}  // namespace

LevellingWatch::LevellingWatch(const RobotModel& model)
    : on_platform_(model.accelerometer_mount == AccelerometerMount::Platform),
      stop_(model.max_aim - kAtStop),
      felt_(accelerometer_place(model)) {}

void LevellingWatch::update(const Inputs& inputs) {
  for (const Odometry& odometry : inputs.odometry) felt_.follow(odometry);
  for (const AimState& aim : inputs.aims) {
    if (!std::isfinite(aim.pitch) || !std::isfinite(aim.roll)) continue;
    aim_ = LaserAim{aim.pitch, aim.roll};
    last_aim_ = inputs.now;
  }
  for (const Acceleration& acceleration : inputs.accelerations) {
    if (acceleration.stamp > inputs.now || !std::isfinite(acceleration.x) || !std::isfinite(acceleration.y)) continue;
    last_felt_ = inputs.now;
    feel(acceleration);
  }
  if (state_ == LevellingState::Jammed) return;
  // What has no servos cannot fail to level: a log with an accelerometer alone.
  const bool silent = aim_ && (is_silent(last_aim_, inputs.now) || is_silent(last_felt_, inputs.now));
  state_ = silent ? LevellingState::Silent : LevellingState::Works;
}

bool LevellingWatch::level() const {
  return state_ == LevellingState::Works && std::abs(pitch_.tilt) < kTilted && std::abs(roll_.tilt) < kTilted;
}

void LevellingWatch::feel(const Acceleration& acceleration) {
  if (!on_platform_ || !aim_ || jammed_at_) return;
  const double dt = last_sample_ == Stamp::never() ? kTiltSilence : acceleration.stamp - last_sample_;
  if (dt <= 0.0) return;
  last_sample_ = acceleration.stamp;
  const Tilt tilt = felt_.of(acceleration);
  const bool pitch = turns_in_vain(pitch_, tilt.pitch, aim_->pitch, dt, acceleration.stamp);
  const bool roll = turns_in_vain(roll_, tilt.roll, aim_->roll, dt, acceleration.stamp);
  if (!pitch && !roll) return;
  jammed_at_ = LaserAim{pitch_.level_aim, roll_.level_aim};
  state_ = LevellingState::Jammed;
}

bool LevellingWatch::turns_in_vain(Axis& axis, double tilt, double aim, double dt, Stamp now) const {
  axis.tilt += (1.0 - std::exp(-dt / kTiltFilter)) * (tilt - axis.tilt);
  const bool level = std::abs(axis.tilt) < kLevel && dt < kTiltSilence;  // of what was between nobody knows
  axis.level_for = level ? axis.level_for + dt : 0.0;
  if (axis.level_for >= kLevelFor && std::abs(aim) < kLeans) axis.level_aim = aim;
  // Jammed on a ramp, its aim ends far off. Back on level ground the platform is level, and nothing calls that aim
  // back.
  axis.leans_for = level && std::abs(aim) >= kLeans ? axis.leans_for + dt : 0.0;
  const double turned = aim - axis.level_aim;
  const bool at_stop = std::abs(aim) >= stop_;
  const bool far = std::abs(turned) >= kAimedFar || (at_stop && stop_ > kLeans);
  const bool in_vain = far && std::abs(axis.tilt) >= kTilted && turned * axis.tilt < 0.0;
  if (!in_vain || dt >= kTiltSilence) {
    axis.in_vain_since = Stamp::never();
  } else if (axis.in_vain_since == Stamp::never() || std::abs(axis.tilt) < axis.in_vain_tilt - kTakenAway) {
    axis.in_vain_since = now;
    axis.in_vain_tilt = std::abs(axis.tilt);
  }
  const double patience = at_stop ? kAtStopFor : kLevelledFor;
  return axis.leans_for >= kLeansFor || (axis.in_vain_since != Stamp::never() && now - axis.in_vain_since >= patience);
}

}  // namespace rubble::robot
