#pragma once

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>

#include "robot/logs/foreign/module/to_mrpt.h"

namespace rubble::slam {

/// What MRPT's builders take at a time, as MRPT's own programs make it of a log.
struct ActionObservation {
  mrpt::obs::CActionCollection action;
  mrpt::obs::CSensoryFrame frame;

  ActionObservation(const mrpt::math::TPose2D& step, const robot::LaserScan& scan,
                    const mrpt::math::TPose3D& T_base_laser) {
    mrpt::obs::CActionRobotMovement2D motion;
    motion.computeFromOdometry(mrpt::poses::CPose2D(step), {});
    const auto observation = mrpt::obs::CObservation2DRangeScan::Create();
    robot::to_mrpt(scan, T_base_laser, *observation);
    observation->sensorLabel = "LASER";
    motion.timestamp = observation->timestamp;
    action.insert(motion);
    frame.insert(observation);
  }
};

}  // namespace rubble::slam
