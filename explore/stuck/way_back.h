#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <vector>

#include "base/stamp.h"
#include "explore/anchor.h"
#include "robot/commands.h"

namespace rubble::explore {

/// The last poses on the robot's way, loops left out: where turning is not free, as between the steps of crossing
/// ramps, the way out is the way in, pose by pose.
class WayBack {
 public:
  /// Takes in where the robot is. Where it was so before, all between is forgotten.
  void add(Stamp now, const mrpt::math::TPose2D& T_map_base);
  /// The mapper corrected its past.
  void follow(const slam::Mapper& mapper);

  /// The drive towards the pose before this one; nothing when none is left.
  std::optional<robot::Drive> drive(const mrpt::math::TPose2D& T_map_base) const;

 private:
  std::vector<Anchor> way_;
};

}  // namespace rubble::explore
