#pragma once

#include <mrpt/math/TPose3D.h>

#include "robot/measurements.h"

namespace mrpt::obs {
class CObservation2DRangeScan;
class CObservationOdometry;
}  // namespace mrpt::obs

namespace rubble::robot {

/// Our scan as MRPT's: the sensor pose takes up the part of the bearings that is not symmetric about the laser's x
/// axis. Returns keep their bits and are valid; a miss becomes the maximum range, invalid; no measurement becomes 0,
/// invalid. Lost: beam_period, range_min, angles beyond float precision, time below 100 ns.
void to_mrpt(const LaserScan& scan, const mrpt::math::TPose3D& T_base_laser, mrpt::obs::CObservation2DRangeScan& out);

/// Lost: `stalled`, time below 100 ns, whole turns of the heading.
void to_mrpt(const Odometry& odometry, mrpt::obs::CObservationOdometry& out);

}  // namespace rubble::robot
