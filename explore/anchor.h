#pragma once

#include <mrpt/math/TPose2D.h>

#include "base/stamp.h"
#include "slam/mapper.h"

namespace rubble::explore {

/// Where the robot was at a moment. What is kept relative to an anchor moves with the map when the mapper corrects its
/// past.
struct Anchor {
  Stamp stamp;
  mrpt::math::TPose2D T_map_base;

  /// Takes over what the mapper knows now about that moment.
  void follow(const slam::Mapper& mapper) {
    if (const auto now = mapper.pose_at(stamp)) T_map_base = *now;
  }
};

}  // namespace rubble::explore
