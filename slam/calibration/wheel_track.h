#pragma once

#include <mrpt/math/TPose2D.h>

#include <vector>

#include "robot/measurements.h"

namespace rubble::slam {

/// What the wheels say about the motion, to be looked at under different scales.
class WheelTrack {
 public:
  /// Takes the next odometry; one that is not younger than the newest is ignored.
  void add(const robot::Odometry& odometry);

  /// Reckons the whole track anew: true distance and true turn per recorded ones, as the base's driver applies them.
  void scale(double distance, double turn);

  bool covers(Stamp stamp) const;
  /// Time between the reports around `stamp`, which must be covered [s].
  double gap_at(Stamp stamp) const;
  /// T_odom_base, a smooth curve through the reports: between two that lie 0.1 s apart a robot that begins to turn at
  /// 100 deg/s^2 is 0.12 deg off the straight line. Before the first and after the last report: that report.
  mrpt::math::TPose2D pose_at(Stamp stamp) const;
  mrpt::math::TPose2D between(Stamp from, Stamp to) const;

  double distance() const { return distance_; }  ///< along the way, as scaled [m]
  double turn() const { return turn_; }          ///< to and fro, as scaled [rad]
  const std::vector<robot::Odometry>& reports() const { return reports_; }

 private:
  std::size_t after_or_at(Stamp stamp) const;

  std::vector<robot::Odometry> reports_;
  std::vector<mrpt::math::TPose2D> poses_;  ///< scaled; headings go on beyond a turn
  double distance_ = 0.0;
  double turn_ = 0.0;
};

}  // namespace rubble::slam
