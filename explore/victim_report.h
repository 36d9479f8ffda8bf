#pragma once

#include <mrpt/math/TPoint2D.h>

#include <vector>

#include "base/stamp.h"
#include "robot/measurements.h"

namespace rubble::explore {

/// A victim as the explorer believes in it.
struct VictimReport {
  int id = 0;                        ///< 1, 2, ... in the order of confirmation
  mrpt::math::TPoint2D p_map;        ///< [m]
  Stamp stamp;                       ///< of the confirmation
  double confidence = 0.0;           ///< 0..1
  std::vector<robot::CueKind> cues;  ///< kinds seen, ascending
};

}  // namespace rubble::explore
