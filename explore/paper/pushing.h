#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <vector>

#include "explore/paper/known_ground.h"
#include "explore/plan/traversable.h"

namespace rubble::explore {

/// Things that stand alone and may be crumpled paper are driven at when nothing else can be reached: first single ones,
/// then heaps of them. What is being pushed rolls, so the newest scans show it where the map does not: such hits are no
/// new obstacle.
class Pushing {
 public:
  /// Things that stand alone and are no wider are driven at; 0: none [m].
  double extent() const { return extent_; }
  bool on() const { return extent_ > 0.0; }
  /// Wider things may be driven at than are now.
  bool more() const;
  /// Whether pushing is worth while for the sake of new ground: in this round it was not tried yet, or ground was
  /// gained since then, or it has begun.
  bool worth(const Traversable& floor) const;

  /// Drives at small things from now on, or at wider ones if it does already. Returns whether at single ones.
  bool start(const Traversable& floor);
  void end() { extent_ = 0.0; }
  /// A new round begins: things are driven round again, and it may be tried again in it.
  void new_round() {
    end();
    known_then_.forget();
  }

  /// The hits of the newest scan but for those on what is pushed, of a robot at T_map_base on `floor`, whose loose
  /// things they are [m, map frame].
  std::vector<mrpt::math::TPoint2D> without_loose_things(const std::vector<mrpt::math::TPoint2D>& hits,
                                                         const mrpt::math::TPose2D& T_map_base,
                                                         const Traversable& floor);
  /// There were such hits.
  bool near_loose_things() const { return !rolling_.empty(); }

 private:
  double extent_ = 0.0;                        ///< [m]
  std::vector<mrpt::math::TPoint2D> rolling_;  ///< hits on what is being pushed, of the last check [m, map frame]
  KnownGround known_then_;                     ///< when it began last in this round
};

}  // namespace rubble::explore
