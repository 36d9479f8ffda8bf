#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <vector>

#include "base/stamp.h"
#include "explore/anchor.h"
#include "explore/plan/path_follower.h"
#include "robot/model.h"
#include "slam/mapper.h"

namespace rubble::explore {

/// Holds fresh hits against the path: things that moved, or that the map does not show yet. What blocked the path is
/// remembered for a while as obstacles.
class PathWatch {
 public:
  explicit PathWatch(const robot::RobotModel& model) : model_(model) {}

  /// Whether a check is due; it then counts as made.
  bool due(Stamp now);
  /// Checks the way ahead, planned with `d_min` [m], at `speed` [m/s]. True when something new stands in it.
  bool check(const PathFollower& follower, const std::vector<mrpt::math::TPoint2D>& hits,
             const mrpt::math::TPose2D& T_map_base, double speed, double d_min, Stamp now);
  /// A new path was chosen.
  void unblock() { blocked_ = false; }
  /// The robot waits for a better path.
  bool waits(Stamp now) const { return blocked_ && now >= creep_until_; }

  /// What is remembered [m, map frame]; forgets what is too old.
  std::vector<mrpt::math::TPoint2D> obstacles(Stamp now);
  /// Remembers what it found last for `seconds` at least: as long as the robot needs for the way round it. It would
  /// turn back half-way else, and find it again.
  void remember(double seconds, Stamp now);
  void forget() {
    found_ = {};
    kept_.clear();
  }
  /// The mapper corrected its past.
  void follow(const slam::Mapper& mapper);

  /// The map shows a way, the newest scans do not: go and see, slowly, and do not wait for a better one meanwhile.
  void creep(Stamp now);
  /// Something is being pushed: slowly, for a moment. What else stands in the way is waited for.
  void slow_down(Stamp now);
  /// Slows a command down while creeping or pushing. Paths are driven forwards.
  robot::Drive limited(robot::Drive drive, Stamp now) const;

 private:
  struct Found {
    std::vector<AnchoredPoint> points;
    Stamp forget = Stamp::never();
  };

  robot::RobotModel model_;
  Stamp next_check_ = Stamp::never();
  Found found_;              ///< last
  std::vector<Found> kept_;  ///< to be remembered for longer
  bool blocked_ = false;
  Stamp creep_until_ = Stamp::never();
  Stamp slow_until_ = Stamp::never();
};

}  // namespace rubble::explore
