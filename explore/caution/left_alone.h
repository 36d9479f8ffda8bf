#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <optional>
#include <vector>

#include "base/grid.h"
#include "base/stamp.h"
#include "explore/anchor.h"
#include "explore/caution/attempts.h"
#include "explore/caution/blacklist.h"
#include "explore/caution/felt_obstacles.h"
#include "explore/caution/pallet_grid.h"
#include "explore/caution/trail.h"
#include "robot/model.h"
#include "slam/mapper.h"

namespace rubble::explore {

/// What the robot failed at and leaves alone for that: targets it could not have, and things it felt. All of it may be
/// wrong, or be gone by now, so all of it can be forgiven, in three degrees: `pardon`, `pardon_all`, `forget`.
class LeftAlone {
 public:
  /// `same_target`: targets closer together are one [m].
  LeftAlone(const FeltConfig& felt, double same_target) : config_(felt), attempts_(same_target), felt_(felt) {}

  /// Bars what lies around a target for a minute, twice as long each time; the robot is at `anchor`. What cost `cost`
  /// [m] when it was chosen is barred for ten seconds a metre if that is longer: else it would be tried again as soon
  /// as the robot has come back.
  void bar(const mrpt::math::TPoint2D& target, const Anchor& anchor, double cost = 0.0);
  /// Until all is pardoned.
  void bar_for_good(const mrpt::math::TPoint2D& target, const Anchor& anchor);
  bool barred(const mrpt::math::TPoint2D& p_map, Stamp now) const { return blacklist_.barred(p_map, now); }

  bool barred_for_good(const mrpt::math::TPoint2D& p_map) const { return blacklist_.barred_for_good(p_map); }

  /// Spends `dt` [s] on a target that cost `cost` [m] when it was first chosen; true when that is more than it
  /// deserves. The robot is at `anchor`.
  bool overdrawn(const mrpt::math::TPoint2D& target, double cost, double dt, const Anchor& anchor) {
    return attempts_.overdrawn(target, cost, dt, anchor);
  }
  /// New things made the robot turn away from a target to another one; true when they did so before.
  bool turned_away(const mrpt::math::TPoint2D& target) { return attempts_.turned_away(target); }

  /// Something stopped the body at `anchor`, right before it or, when it drove backwards, `behind` it. `known`: the
  /// map, in which pallets may show; `sure`: something struck it. Says whether a whole pallet is left alone for it.
  bool feel(const Anchor& anchor, bool behind, const robot::RobotModel& model, const OccupancyGrid& known,
            const Trail& trail, bool sure = false);
  /// Something holds the robot here: the pallet that it has to get out of, if it is on one that was let go of or that
  /// it did not get free of.
  std::optional<Trap> trap(const mrpt::math::TPose2D& T_map_base) { return felt_.trap(T_map_base); }
  /// It tried in vain to get away.
  void not_got_free(const Anchor& anchor, const OccupancyGrid& known);
  /// The robot stands here in good order.
  void passed(const mrpt::math::TPose2D& T_map_base, const robot::RobotModel& model) {
    felt_.passed(T_map_base, model);
  }
  /// The mapper corrected its past.
  void follow(const slam::Mapper& mapper) {
    blacklist_.follow(mapper);
    attempts_.follow(mapper);
    felt_.follow(mapper);
  }
  /// What counts as an obstacle now [m, map frame].
  std::vector<mrpt::math::TPoint2D> obstacles(Stamp now) const { return felt_.points(now); }

  /// Tries again what would be tried again some day, and counts less what was felt. This and the two below say whether
  /// there was anything to forgive.
  bool pardon(Stamp now);
  /// The same, and targets barred for good as well.
  bool pardon_all(Stamp now);
  /// Forgets all that was felt, what is certain as well, until it is felt again. Targets stay barred.
  bool forget(Stamp now) { return felt_.forget(now); }
  /// Forgets what was felt but never forgotten before: each thing gets one chance more, not many.
  bool forget_once(Stamp now) { return felt_.forget_once(now); }
  /// Something was felt that was never forgotten.
  bool has_chances() const { return felt_.has_chances(); }

 private:
  std::optional<PalletGrid> pallets(const Anchor& anchor, const OccupancyGrid& known) const;

  FeltConfig config_;
  Blacklist blacklist_;
  Attempts attempts_;
  FeltObstacles felt_;
};

}  // namespace rubble::explore
