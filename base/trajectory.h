#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <string>
#include <vector>

#include "base/stamp.h"

namespace rubble {

struct StampedPose {
  Stamp stamp;
  mrpt::math::TPose2D pose;
};

/// Poses in the order of their stamps (strictly increasing).
using Trajectory = std::vector<StampedPose>;

/// Linear in x and y, shortest way round in the angle; u = 0 gives a, u = 1 gives b.
mrpt::math::TPose2D interpolate(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b, double u);

/// The pose at `stamp`, between its two neighbours; nothing outside the time the trajectory covers.
std::optional<mrpt::math::TPose2D> pose_at(const Trajectory& trajectory, Stamp stamp);

/// Two poses of one instant.
struct PosePair {
  mrpt::math::TPose2D estimate;
  mrpt::math::TPose2D truth;
};

/// Pairs each pose of the estimate with the truth at its stamp; those outside the time of the truth have no partner.
std::vector<PosePair> associate(const Trajectory& estimate, const Trajectory& truth);

/// Seconds with nine decimals, as TUM text and tables have them.
std::string stamp_text(Stamp stamp);

/// One line of TUM text, `time x y z qx qy qz qw`, one space, no trailing space (as evo reads it). z = 0.
std::string tum_line(const StampedPose& stamped);

/// Reads TUM text; '#' starts a comment. z, roll and pitch are dropped. Throws InputError with file, line and column.
Trajectory read_tum(const std::string& path);

}  // namespace rubble
