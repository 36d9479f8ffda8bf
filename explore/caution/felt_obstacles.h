#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <optional>
#include <vector>

#include "base/grid.h"
#include "base/stamp.h"
#include "explore/anchor.h"
#include "explore/caution/pallet_grid.h"
#include "explore/caution/trap.h"
#include "robot/model.h"
#include "slam/mapper.h"

namespace rubble::explore {

struct FeltConfig {
  double memory = 120.0;    ///< a bar that was felt once is an obstacle for this long; doubles with each time more [s]
  double pallet = 1.2;      ///< size of the elements that the arena is built of [m]; 0: of none
  double same_thing = 0.5;  ///< felt this close to an earlier one: the same thing [m]
  int certain = 3;          ///< felt so often, it stands there for good
  int tries = 3;            ///< a pallet that can be driven on but was felt so often is left alone once left
};

/// What the scanner cannot see but the robot felt: steps, blocks and edges that stopped it, ground too steep for it.
/// Each is a short bar across the way, kept relative to the pose at which it was felt, with a time until which it
/// counts; what was felt again counts longer. Where the arena's pallets are known and the edge of one was felt that the
/// robot has not stood on, the whole pallet counts, without an end: a step field is met at most twice, not from all
/// sides.
class FeltObstacles {
 public:
  explicit FeltObstacles(const FeltConfig& config = {}) : config_(config) {}

  /// Something right before the body stopped it, or behind it when it drove backwards. `grid`: the arena's pallets;
  /// `trail`: where the robot's middle has been; `known`: the map, through whose walls no corner of the body reaches.
  /// `sure`: a blow or a stall says so, not only that the robot stands: such a pallet is not pardoned.
  /// Says whether it takes a whole pallet for an obstacle.
  bool feel(const Anchor& anchor, bool behind, const robot::RobotModel& model,
            const std::optional<PalletGrid>& grid = std::nullopt, const std::vector<mrpt::math::TPoint2D>& trail = {},
            const OccupancyGrid* known = nullptr, bool sure = false);
  /// Something holds the robot here. Where that is on a pallet that was taken for an obstacle and then let go of, or
  /// that it did not get free of (`not_got_free`), it is one: it is left alone once the robot has left it. Returns that
  /// pallet.
  std::optional<Trap> trap(const mrpt::math::TPose2D& T_map_base);
  /// The robot was held here and did not get away: the pallet below its middle holds it, whatever was met first.
  void not_got_free(const Anchor& anchor, const PalletGrid& grid);
  /// The robot stands here in good order: what was felt below the middle of its body is not there, or can be passed; a
  /// pallet it stands on can be driven on.
  void passed(const mrpt::math::TPose2D& T_map_base, const robot::RobotModel& model);
  /// The mapper corrected its past.
  void follow(const slam::Mapper& mapper);

  /// What counts as an obstacle now [m, map frame].
  std::vector<mrpt::math::TPoint2D> points(Stamp now) const;
  /// How many things count now.
  int count(Stamp now) const;
  /// Counts less as an obstacle, for nothing else can be reached: first every bar shrinks to its middle, which leaves a
  /// lane beside it in a corridor, and every pallet that is not sure to the middles of its sides, where crossing ramps
  /// have their high corners; felt again it is taken for a step field, for good. The next time things that are not
  /// certain are forgotten until they are felt again.
  /// Says whether anything changed.
  bool pardon(Stamp now);
  /// Forgets everything until it is felt again; says whether anything counted.
  bool forget(Stamp now);
  /// Forgets what was never forgotten so before: what was felt again since stays. Says whether there was any.
  bool forget_once(Stamp now);
  /// There is something that was never forgotten so.
  bool has_chances() const;

 private:
  struct Thing {
    Anchor anchor;
    double side = 1.0;      ///< 1: before the body, -1: behind it
    double reach = 0.0;     ///< of the bar from the base origin [m]
    double half_bar = 0.0;  ///< [m]
    int times = 1;
    Stamp until = Stamp::never();
    bool is_pallet = false;
    bool whole = false;                 ///< all of the pallet counts
    bool certain = false;               ///< it was felt again after a pardon
    bool sure = false;                  ///< something struck the body
    bool stubs = false;                 ///< else, whether the middles of its sides count
    bool inside = false;                ///< the robot's middle is on it
    bool let_go = false;                ///< it was an obstacle, and pardoned or forgotten
    bool held = false;                  ///< the robot did not get free of it
    bool shut = false;                  ///< it held the robot after that, or shows steps: it is left alone once left
    bool had_its_chance = false;        ///< it was forgotten once, to be tried again
    mrpt::math::TPose2D T_base_pallet;  ///< of the pallet's middle

    mrpt::math::TPoint2D at(double aside) const;  ///< on the bar [m, map frame]
    mrpt::math::TPose2D pallet() const { return anchor.T_map_base + T_base_pallet; }
  };

  /// All of the pallet is an obstacle.
  bool closed(const Thing& thing) const {
    return thing.whole || ((thing.shut || thing.times >= config_.tries) && !thing.inside);
  }
  bool counts(const Thing& thing, Stamp now) const {
    return now < thing.until && (!thing.is_pallet || thing.stubs || closed(thing));
  }
  void let_go(Thing& thing, Stamp now) const;
  bool feel_pallet(const Thing& touch, const PalletGrid& grid, const robot::RobotModel& model,
                   const std::vector<mrpt::math::TPoint2D>& trail, const OccupancyGrid* known);
  std::optional<Cell> reached(const Thing& touch, const PalletGrid& grid, const robot::RobotModel& model,
                              const std::vector<mrpt::math::TPoint2D>& trail, const OccupancyGrid* known) const;
  std::optional<Cell> field_beside(const Thing& touch, const PalletGrid& grid, const robot::RobotModel& model,
                                   const std::vector<mrpt::math::TPoint2D>& trail, const OccupancyGrid& known) const;
  static std::vector<Cell> new_pallets(const std::vector<mrpt::math::TPoint2D>& points,
                                       const mrpt::math::TPose2D& T_map_base, const PalletGrid& grid,
                                       const std::vector<mrpt::math::TPoint2D>& trail, const OccupancyGrid* known);
  bool felt_on(const mrpt::math::TPoint2D& middle) const;
  bool is_pallet_at(const Thing& thing, const mrpt::math::TPoint2D& middle) const;
  bool holds(const Thing& thing, const mrpt::math::TPoint2D& p_map, double margin) const;

  FeltConfig config_;
  std::vector<Thing> things_;
};

}  // namespace rubble::explore
