#include "robot/logs/foreign/mrpt_bridge.h"

#include "base/angle.h"
#include "robot/logs/foreign/mrpt_stamp.h"

namespace rubble::robot {

LaserScan from_mrpt(const MrptScan& scan, const mrpt::math::TPose3D& T_base_laser) {
  LaserScan out;
  const std::size_t beams = scan.ranges.size();
  const double aperture = static_cast<double>(scan.aperture);
  const mrpt::poses::CPose3D T_laser_sensor = scan.T_base_sensor - mrpt::poses::CPose3D(T_base_laser);
  out.stamp = from_mrpt_time(scan.time);
  out.angle_min = T_laser_sensor.yaw() - 0.5 * aperture;
  out.angle_step = beams < 2 ? 0.0 : aperture / static_cast<double>(beams - 1);
  out.range_max = static_cast<double>(scan.range_max);
  out.ranges.resize(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const std::size_t from = scan.right_to_left ? i : beams - 1 - i;
    const float range = scan.ranges[from];
    const bool missed = range >= scan.range_max;
    out.ranges[i] = range;
    if (!scan.valid[from]) out.ranges[i] = missed ? LaserScan::kMiss : LaserScan::kUnknown;
  }
  return out;
}

Odometry from_mrpt(const MrptOdometry& odometry) {
  Odometry out;
  out.stamp = from_mrpt_time(odometry.time);
  out.pose = odometry.pose.asTPose();
  out.pose.phi = wrap_angle(out.pose.phi);
  out.v = odometry.v;
  out.w = odometry.w;
  return out;
}

}  // namespace rubble::robot
