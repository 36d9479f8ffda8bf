#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <vector>

namespace rubble::scoring {

/// One report that was credited to a victim.
struct VictimMatch {
  std::size_t reported = 0;  ///< index of the report
  std::size_t truth = 0;     ///< index of the victim
  double error_m = 0.0;
};

struct VictimScore {
  std::size_t found = 0;             ///< victims with a report of their own
  std::size_t total = 0;             ///< victims there are
  std::size_t false_alarms = 0;      ///< reports that belong to no victim, doubles included
  double mean_error_m = 0.0;         ///< over the matches; 0 when there is none
  std::vector<VictimMatch> matches;  ///< in the order of the reports
};

/// Assigns reports to victims one to one, as many as lie within `reach` [m] of each other, and among those assignments
/// the one with the smallest summed distance (Hungarian method). 1.2 m is one pallet.
VictimScore score_victims(const std::vector<mrpt::math::TPoint2D>& reported,
                          const std::vector<mrpt::math::TPoint2D>& truth, const mrpt::math::TPose2D& T_truth_map,
                          double reach = 1.2);

}  // namespace rubble::scoring
