#pragma once

#include <mrpt/math/TPoint2D.h>

#include "robot/model.h"
#include "robot/tilt.h"

namespace rubble::robot {

/// Friction of the wheels on the floor of an arena.
inline constexpr double kRubberOnWood = 0.8;

/// How a skid-steered robot that turns slides down the slope it stands on.
///
/// Its wheels at (+-a, +-b) slip all the time then: across by w a, along by so much that the four friction forces of
/// mu N each turn nothing, a / b times that. A force that slips already resists a small slip u more by
/// mu N / |slip| times the square of the sine between the two, so by Coulomb friction alone
///   v_along = -tan(pitch) |w| a / (mu q^3),  v_across = -tan(roll) |w| a / (mu p^2 q),
///   p = a / sqrt(a^2 + b^2), q = b / sqrt(a^2 + b^2).
/// On a slope of 10 deg a Pioneer 3-AT that turns by 60 deg/s slides by 0.12 m/s across, which its wheels do not tell.
class SlopeCreep {
 public:
  /// friction: of its wheels on the floor; 0: it does not creep.
  SlopeCreep(const RobotModel& model, double friction);

  /// While it turns by `turn` [rad], inclined like this: in the base frame [m].
  mrpt::math::TPoint2D expected(const Tilt& lean, double turn) const;
  /// The same if the slope lay across it, whichever way it does: down the slope, in the base frame [m].
  mrpt::math::TPoint2D across(const Tilt& lean, double turn) const;

 private:
  double slope(double angle) const;

  double along_ = 0.0;     ///< of a slope of 1 [m/rad]
  double across_ = 0.0;    ///< [m/rad]
  double steepest_ = 0.0;  ///< slopes count up to this
};

}  // namespace rubble::robot
