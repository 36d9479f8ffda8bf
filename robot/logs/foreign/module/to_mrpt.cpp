#include "robot/logs/foreign/module/to_mrpt.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <cmath>

#include "robot/logs/foreign/mrpt_stamp.h"

namespace rubble::robot {
namespace {

using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservationOdometry;
using mrpt::poses::CPose3D;

/// From the middle of the first to the middle of the last beam [rad].
double aperture_of(const LaserScan& scan) {
  return scan.ranges.size() < 2 ? 0.0 : static_cast<double>(scan.ranges.size() - 1) * scan.angle_step;
}

}  // namespace

void to_mrpt(const LaserScan& scan, const mrpt::math::TPose3D& T_base_laser, CObservation2DRangeScan& out) {
  const double aperture = aperture_of(scan);
  const double centre = scan.angle_min + 0.5 * aperture;
  out.timestamp = to_mrpt_time(scan.stamp);
  out.sensorPose = CPose3D(T_base_laser) + CPose3D(0, 0, 0, centre, 0, 0);
  out.aperture = static_cast<float>(aperture);
  out.rightToLeft = true;
  out.maxRange = static_cast<float>(scan.range_max);
  out.resizeScan(scan.ranges.size());
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const float range = scan.ranges[i];
    const bool missed = range == LaserScan::kMiss;
    out.setScanRange(i, missed ? out.maxRange : (std::isfinite(range) ? range : 0.0f));
    out.setScanRangeValidity(i, std::isfinite(range));
  }
}

void to_mrpt(const Odometry& odometry, CObservationOdometry& out) {
  out.timestamp = to_mrpt_time(odometry.stamp);
  out.odometry = mrpt::poses::CPose2D(odometry.pose);
  out.hasVelocities = true;
  out.velocityLocal = {odometry.v, 0.0, odometry.w};
}

}  // namespace rubble::robot
