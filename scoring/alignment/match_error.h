#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace rubble::scoring {

/// What eq. (7) asks of a set of features at a pose, section IV.F step 3.
struct MatchError {
  double error = 0.0;        ///< E [m^2], 0 .. cap; the cap where nothing is matched: W = 0 is the worst, not the best
  std::size_t matched = 0;   ///< pairs
  double mean_offset = 0.0;  ///< mean distance of matched features [m]
  /// w_ij = 1: features of the map and of the truth, in the order of the map's.
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
};

/// The best one-to-one association W at a pose and its error (scoring/measures/association.h), with
/// c_ij = squared distance + difference(i, j) [m^2].
MatchError match_error(const std::vector<mrpt::math::TPoint2D>& map, const std::vector<mrpt::math::TPoint2D>& truth,
                       const mrpt::math::TPose2D& T_truth_map,
                       const std::function<double(std::size_t map, std::size_t truth)>& difference, double cap);

}  // namespace rubble::scoring
