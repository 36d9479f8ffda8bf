#pragma once

#include <mrpt/math/TPoint2D.h>

#include <vector>

#include "explore/anchor.h"

namespace rubble::explore {

/// Keeps account of the time spent on the way to each target, so that driving to and fro between targets that move out
/// of reach ends some day.
class Attempts {
 public:
  /// `same_target`: targets closer together are one [m].
  explicit Attempts(double same_target) : same_target_(same_target) {}

  /// Spends `dt` seconds on a target that cost `cost` metres when it was first chosen; true when that is more time than
  /// it deserves. The account is then closed: choosing the target again opens a new one. Chosen again from farther away
  /// it gets what that is more. The robot is at `anchor`.
  bool overdrawn(const mrpt::math::TPoint2D& target, double cost, double dt, const Anchor& anchor);
  /// New things made the robot turn away to another target; true when they did so before.
  bool turned_away(const mrpt::math::TPoint2D& target);
  /// The mapper corrected its past.
  void follow(const slam::Mapper& mapper);

 private:
  struct Account {
    AnchoredPoint target;
    double budget;  ///< [s]
    double cost;    ///< for which it was granted [m]
    bool turned_away = false;
  };
  double same_target_;
  std::vector<Account> accounts_;
};

}  // namespace rubble::explore
