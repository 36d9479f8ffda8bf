#pragma once

#include <mrpt/math/TPoint2D.h>

#include <vector>

#include "base/stamp.h"
#include "explore/anchor.h"

namespace rubble::explore {

/// Places not to drive to for a while: frontiers that could not be reached, or that stay although they were visited.
class Blacklist {
 public:
  /// Bars the disc of `radius` [m] around p, a place of the map of this moment, until `until`.
  void bar(const AnchoredPoint& p, double radius, Stamp until);
  /// Bars the disc until all is pardoned; what was barred so before, for as long as the blacklist lives.
  void bar_for_good(const AnchoredPoint& p, double radius);
  /// The mapper corrected its past.
  void follow(const slam::Mapper& mapper);

  bool barred(const mrpt::math::TPoint2D& p_map, Stamp now) const;
  /// Barred for as long as nobody pardons all.
  bool barred_for_good(const mrpt::math::TPoint2D& p_map) const;
  /// How often discs around p were barred so far, expired ones included.
  int times_barred(const mrpt::math::TPoint2D& p_map) const;
  /// Ends all bars that would end some day; says whether there was any in force.
  bool pardon(Stamp now);
  /// Ends all bars, those for good as well but for what was barred so twice; says whether there was any in force.
  bool pardon_all(Stamp now);

 private:
  struct Entry {
    AnchoredPoint p;
    double radius;
    Stamp until;
    bool for_good = false;
    bool twice = false;  ///< it was barred for good before
  };
  std::vector<Entry> entries_;
};

}  // namespace rubble::explore
