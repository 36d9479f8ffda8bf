#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <vector>

#include "base/stamp.h"
#include "explore/anchor.h"
#include "robot/model.h"
#include "slam/mapper.h"

namespace rubble::explore {

struct FeltConfig {
  double memory = 120.0;    ///< what was felt once is an obstacle for this long; doubles with each time more [s]
  double same_thing = 0.5;  ///< felt this close to an earlier one: the same thing [m]
  int certain = 3;          ///< felt so often, it stands there for good
};

/// What the scanner cannot see but the robot felt: steps, blocks and edges that stopped it, ground too steep for it.
/// Each is a short bar across the way, kept relative to the pose at which it was felt, with a time until which it
/// counts; what was felt again counts longer.
class FeltObstacles {
 public:
  explicit FeltObstacles(const FeltConfig& config = {}) : config_(config) {}

  /// Something right before the body stopped it, or behind it when it drove backwards.
  void feel(const Anchor& anchor, bool behind, const robot::RobotModel& model);
  /// The robot stands here in good order: what was felt below the middle of its body is not there, or can be passed.
  void passed(const mrpt::math::TPose2D& T_map_base, const robot::RobotModel& model);
  /// The mapper corrected its past.
  void follow(const slam::Mapper& mapper);

  /// What counts as an obstacle now [m, map frame].
  std::vector<mrpt::math::TPoint2D> points(Stamp now) const;
  /// How many things count now.
  int count(Stamp now) const;
  /// Counts less as an obstacle, for nothing else can be reached: first every bar shrinks to its middle, which leaves a
  /// lane beside it in a corridor; the next time things that are not certain are forgotten until they are felt again.
  /// Says whether anything changed.
  bool pardon(Stamp now);
  /// Forgets everything until it is felt again; says whether anything counted.
  bool forget(Stamp now);

 private:
  struct Thing {
    Anchor anchor;
    double side = 1.0;      ///< 1: before the body, -1: behind it
    double reach = 0.0;     ///< of the bar from the base origin [m]
    double half_bar = 0.0;  ///< [m]
    int times = 1;
    Stamp until = Stamp::never();

    mrpt::math::TPoint2D at(double aside) const;  ///< on the bar [m, map frame]
  };

  FeltConfig config_;
  std::vector<Thing> things_;
};

}  // namespace rubble::explore
