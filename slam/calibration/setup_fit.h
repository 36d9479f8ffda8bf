#pragma once

#include <vector>

#include "slam/calibration/laser_motions.h"
#include "slam/calibration/robot_setup.h"
#include "slam/calibration/wheel_track.h"

namespace rubble::slam {

struct SetupFit {
  RobotSetup setup;
  RobotSetup sigma;             ///< standard deviations; T_base_laser: of x, y, phi
  double position_error = 0.0;  ///< of a scan against the wheels under the setup, middle of all [m]
  double turn_error = 0.0;      ///< [rad]
  int scans = 0;
};

/// The setup under which the wheels' motions agree best with those that the scans saw. Simultaneous calibration of
/// odometry and sensor in the way of Censi, Franchi, Marchionni, Oriolo (IEEE T-RO 29(2), 2013), whose equation
/// o + l = l + s it takes, but for two things: the residuals are minimised together with the unknown delay by
/// Gauss-Newton, and each scan's error counts once, for the first scan's error is an unknown of its stretch.
/// Scans that do not fit count less (Cauchy). The uncertainties allow for errors that the scans of a stretch share
/// (grouped "sandwich" covariance). `wheels` is left scaled as the setup says.
SetupFit fit_setup(const std::vector<LaserStretch>& stretches, WheelTrack& wheels, const RobotSetup& start);

}  // namespace rubble::slam
