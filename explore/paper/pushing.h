#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <vector>

#include "explore/caution/local_grids.h"
#include "explore/paper/known_ground.h"
#include "explore/plan/traversable.h"

namespace rubble::explore {

/// Things that stand alone and may be crumpled paper are driven at when nothing else can be reached: first single ones,
/// then heaps of them, then strips that hang in a row, at last all that stands off the grid of the pallets. What is
/// being pushed rolls, so the newest scans show it where the map does not: such hits are no new obstacle.
class Pushing {
 public:
  enum class What { Nothing, Single, Heaps, Strips, OffGrid };  ///< each with those before it

  /// `pallet`: size of the elements that the arena is built of, 0: of none [m].
  explicit Pushing(double pallet = 0.0) : pallet_(pallet) {}
  What what() const { return what_; }
  bool on() const { return what_ != What::Nothing; }
  /// More may be driven at than is now.
  bool more() const { return what_ != What::OffGrid; }
  /// Makes free on `floor` what is driven at. `known`: grids of pallets of earlier calls.
  void free_things(Traversable& floor, KnownGrids* known = nullptr) const;
  /// Whether pushing is worth while for the sake of new ground: in this round it was not tried yet, or ground was
  /// gained since then, or it has begun.
  bool worth(const Traversable& floor) const;

  /// Drives at single things from now on, or at the next kind if it does already. Returns at what.
  What start(const Traversable& floor);
  /// Drives from now on at what may be the floor of a slope, off the grid and wide, and at no small things.
  void start_on_slopes() {
    what_ = What::OffGrid;
    slopes_only_ = true;
  }
  void end() {
    what_ = What::Nothing;
    slopes_only_ = false;
  }
  /// A new round begins: things are driven round again, and it may be tried again in it.
  void new_round() {
    end();
    known_then_.forget();
  }

  /// The hits of the newest scan but for those on what is pushed, and on what is hoped to be the floor of a slope
  /// unless they show that it is none, of a robot at T_map_base on `floor`, whose loose things they are [m, map frame].
  std::vector<mrpt::math::TPoint2D> without_loose_things(const std::vector<mrpt::math::TPoint2D>& hits,
                                                         const mrpt::math::TPose2D& T_map_base,
                                                         const Traversable& floor);
  /// There were such hits near the robot.
  bool near_loose_things() const { return near_; }
  /// What was hoped to be the floor of a slope and was met from near: it is none [m, map frame].
  const std::vector<mrpt::math::TPoint2D>& solid() const { return solid_; }

 private:
  double pallet_;
  What what_ = What::Nothing;
  bool slopes_only_ = false;
  // Of the last check [m, map frame]:
  std::vector<mrpt::math::TPoint2D> rolling_;  ///< hits on what is being pushed
  std::vector<mrpt::math::TPoint2D> solid_;
  bool near_ = false;
  KnownGround known_then_;  ///< when it began last in this round
};

}  // namespace rubble::explore
