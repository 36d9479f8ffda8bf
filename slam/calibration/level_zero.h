#pragma once

#include <optional>
#include <vector>

#include "robot/measurements.h"
#include "robot/model.h"
#include "slam/calibration/wheel_track.h"

namespace rubble::slam {

/// What the accelerometer says where there is nothing to be felt.
struct LevelZero {
  double pitch = 0.0;        ///< told by a level sensor, to be taken off [rad]
  double roll = 0.0;         ///< [rad]
  double pitch_sigma = 0.0;  ///< [rad]
  double roll_sigma = 0.0;   ///< [rad]
  double slope = 0.0;        ///< of the floor, which shows as it turns under the robot [rad]
  bool slope_known = false;  ///< else the robot did not turn enough, and the floor is taken to be level
  int stands = 0;            ///< times the robot stood still
};

/// From the accelerations while the robot stood still, by the (scaled) wheels. A sensor on the platform is taken to be
/// level where the servos say 0. Nothing: it felt nothing, or never stood for a second.
std::optional<LevelZero> level_zero(const std::vector<robot::Acceleration>& accelerations,
                                    const std::vector<robot::AimState>& aims, const WheelTrack& wheels,
                                    robot::AccelerometerMount mount);

}  // namespace rubble::slam
