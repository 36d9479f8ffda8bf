#pragma once

#include <mrpt/math/TPoint2D.h>
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

/// A place as it lay from an anchor.
class AnchoredPoint {
 public:
  AnchoredPoint(const Anchor& anchor, const mrpt::math::TPoint2D& p_map)
      : anchor_(anchor), p_base_(anchor.T_map_base.inverseComposePoint(p_map)), p_map_(p_map) {}

  /// [m]
  const mrpt::math::TPoint2D& p_map() const { return p_map_; }
  void follow(const slam::Mapper& mapper) {
    anchor_.follow(mapper);
    p_map_ = anchor_.T_map_base.composePoint(p_base_);
  }

 private:
  Anchor anchor_;
  mrpt::math::TPoint2D p_base_, p_map_;
};

}  // namespace rubble::explore
