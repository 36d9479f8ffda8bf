#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <vector>

#include "scoring/walls/overlap.h"

namespace rubble::scoring {

/// A place of the truth where the map is wrong.
struct WrongPlace {
  mrpt::math::TPoint2D p_truth;  ///< centre of gravity of what is wrong there [m]
  double phantom_m = 0.0;        ///< wall of the map that the truth has not [m]
  double missing_m = 0.0;        ///< wall of the truth that the map has not [m]
  double wrong_m() const { return phantom_m + missing_m; }
};

/// Why a score is what it is. Lengths count each wall cell by 1 - k(d): in full from tau on, and by the length that the
/// cell stands for (its area over the walls' mean thickness).
struct WallErrors {
  double phantom_m = 0.0;
  double missing_m = 0.0;
  double gaps_m = 0.0;            ///< of `missing_m` that of windows which miss a third of a pallet and more
  double ignored_m = 0.0;         ///< wall of the map where the truth is unknown: counts neither for nor against it
  std::vector<WrongPlace> worst;  ///< worst first
};

/// `places`: how many windows of 1.2 m, one pallet, are listed at the most; none with less than 0.1 m wrong.
WallErrors wall_errors(const WallOverlap& walls, const PlanarTransform& T_truth_map, std::size_t places);

}  // namespace rubble::scoring
