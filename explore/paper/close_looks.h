#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <deque>
#include <vector>

#include "explore/anchor.h"
#include "explore/plan/traversable.h"
#include "slam/mapper.h"

namespace rubble::explore {

/// What the newest scans say of walls right before the robot that may be none. A level laser meets the floor of a slope
/// of 10 deg from its foot, 2 m away; from half a metre it passes over it, and what it meets there is solid. The map
/// weighs all looks alike, and from the foot there are more of them: here the close ones decide, for good.
class CloseLooks {
 public:
  enum class Verdict { Open, Floor, Solid };

  /// `pallet`: size of the arena's elements [m], 0: all walls are believed. `p_base_laser`: where the laser sits [m].
  CloseLooks(double pallet, const mrpt::math::TPoint2D& p_base_laser) : pallet_(pallet), p_base_laser_(p_base_laser) {}

  /// Takes in the hits of a scan at T_map_base, right before a wall that may be none [m, map frame].
  void look(const std::vector<mrpt::math::TPoint2D>& hits, const mrpt::math::TPose2D& T_map_base);
  /// It stands there no more.
  void look_away() { looks_.clear(); }
  /// Judges what stands about the laser well inside the pallets, or is `unsure`, of `floor`: enough looks passed over
  /// it and hardly any met it, or the other way round. Floor where as much of it is as a body needs.
  Verdict judge(const Traversable& floor, const Anchor& robot);
  /// These places were met by a scan from near: they are solid [m, map frame].
  void met(const std::vector<mrpt::math::TPoint2D>& places, const Anchor& robot);
  /// Makes free what was found to be floor, and marks what is solid.
  void apply(Traversable& floor) const;
  /// The mapper corrected its past.
  void follow(const slam::Mapper& mapper);

 private:
  /// One scan from the laser, by bearing.
  struct Look {
    struct Ray {
      double bearing;  ///< [rad]
      double range;    ///< [m]
    };
    mrpt::math::TPoint2D origin;
    std::vector<Ray> rays;
  };

  /// Of a place in one look: something was met there, or passed over; Open: it was not seen.
  static Verdict seen(const Look& look, const mrpt::math::TPoint2D& p_map);
  /// Of a place in all looks.
  Verdict judge(const mrpt::math::TPoint2D& p_map) const;

  double pallet_;
  mrpt::math::TPoint2D p_base_laser_;
  std::deque<Look> looks_;  ///< the newest
  std::vector<AnchoredPoint> floor_;
  std::vector<AnchoredPoint> solid_;
};

}  // namespace rubble::explore
