#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <vector>

#include "robot/measurements.h"
#include "slam/calibration/robot_setup.h"
#include "slam/calibration/wheel_track.h"

namespace rubble::slam {

/// Where one scan was taken, seen from the first scan of its stretch, by what both saw.
struct SeenPose {
  Stamp stamp;                                            ///< the middle of the scan, as stamped
  mrpt::math::TPose2D T_first_scan;                       ///< of the laser
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< along the axes of the first scan, up to one factor
};

/// A run of scans that all see what the first one saw.
struct LaserStretch {
  Stamp first;
  std::vector<SeenPose> scans;  ///< without the first
};

struct LaserMotionsConfig {
  double longest_turn = 0.9;  ///< of a stretch [rad]
  double longest_way = 0.5;   ///< [m]
  /// Who goes farther and turns by more at once drives an arc, in which wheels slip sideways: that would be taken for a
  /// laser mounted elsewhere (2 to 4 mm off in exploring drives). Those scans are left out.
  double arc_way = 0.05;       ///< [m]
  double arc_turn = 0.1;       ///< [rad]
  double least_inliers = 0.7;  ///< a scan of which less fits the first one is left out
  int least_points = 30;       ///< on surfaces; a scan with fewer says nothing
};

/// Lays each scan on the first of its stretch. The wheels, under the setup as it is known, tell where to look and how
/// the laser moved during a sweep; `scales` of `wheels` are set to those of the setup.
std::vector<LaserStretch> laser_motions(const std::vector<robot::LaserScan>& scans, WheelTrack& wheels,
                                        const RobotSetup& setup, const LaserMotionsConfig& config);

}  // namespace rubble::slam
