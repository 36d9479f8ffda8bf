#include "robot/drivers/watch/levelling_witness.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/angle.h"
#include "robot/hardware_units.h"

namespace rubble::robot {
namespace {

constexpr double kTiltFilter = 0.2;              ///< time constant [s]
constexpr double kTiltGap = 0.5;                 ///< [s]
constexpr double kAimedFar = deg_to_rad(20.0);   ///< such an aim takes away the tilt of any ramp
constexpr double kTiltedFar = deg_to_rad(10.0);  ///< and leaves less than this
constexpr double kAimedLittle = deg_to_rad(5.0);
constexpr double kLevelledFor = 1.0;  ///< longer than servos and loop take [s]

double tilt_of_force(double force) { return std::asin(std::clamp(force / kGravity, -1.0, 1.0)); }

}  // namespace

void LevellingWitness::look(const Acceleration& felt, const AimState& aim) {
  const double dt = last_ == Stamp::never() ? kTiltGap : std::clamp(felt.stamp - last_, 0.0, kTiltGap);
  last_ = felt.stamp;
  look(pitch_, tilt_of_force(felt.x), aim.pitch, dt, felt.stamp);
  look(roll_, tilt_of_force(felt.y), aim.roll, dt, felt.stamp);
}

void LevellingWitness::look(Axis& axis, double tilt, double aim, double dt, Stamp now) {
  axis.tilt += (1.0 - std::exp(-dt / kTiltFilter)) * (tilt - axis.tilt);
  if (std::abs(aim) < kAimedLittle) axis.tilt_before = axis.tilt;
  const bool in_vain = std::abs(aim) >= kAimedFar && std::abs(axis.tilt) >= kTiltedFar && aim * axis.tilt < 0.0;
  if (!in_vain || dt >= kTiltGap) axis.since = Stamp::never();
  if (in_vain && axis.since == Stamp::never()) axis.since = now;
  if (!in_vain || now - axis.since < kLevelledFor || !finding_.empty()) return;
  const double more = std::abs(axis.tilt) - std::abs(axis.tilt_before);
  char text[240];
  if (more > 0.5 * std::abs(aim)) {
    std::snprintf(
        text, sizeof text,
        "makes the tilt larger: aimed at %.0f deg of %s, it feels %.0f deg; has devices.levelling.%s.deg_per_us "
        "the wrong sign?",
        rad_to_deg(aim), axis.name, rad_to_deg(axis.tilt), axis.name);
  } else {
    std::snprintf(
        text, sizeof text,
        "does not take the tilt away: aimed at %.0f deg of %s, it feels %.0f deg; does its servo turn, or has "
        "the robot tipped over?",
        rad_to_deg(aim), axis.name, rad_to_deg(axis.tilt));
  }
  finding_ = text;
}

}  // namespace rubble::robot
