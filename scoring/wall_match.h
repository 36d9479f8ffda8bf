#pragma once

#include <mrpt/math/TPose2D.h>

#include <vector>

#include "base/grid.h"
#include "scoring/wall_field.h"

namespace rubble::scoring {

/// What two maps say about each other at one pose. Shares are 0..1; a side with nothing to say gives 0.
struct PoseEvidence {
  double map_walls = 0.0;           ///< share of the map's walls that lie where the truth knows something
  double map_met = 0.0;             ///< mean k(d) of those
  double truth_walls = 0.0;         ///< share of the truth's walls that lie where the map knows something
  double truth_met = 0.0;           ///< mean k(d) of those
  double map_contradicted = 0.0;    ///< share of the map's known walls deep in free space of the truth
  double truth_contradicted = 0.0;  ///< the same the other way round
  double free_common = 0.0;         ///< share of the smaller free area that is free in both
  double score = 0.0;               ///< one number to rank poses by
};

/// Two maps prepared for comparing them at many poses: wall points, distance fields, free samples of both.
class WallMatch {
 public:
  /// `reach`: distances count up to here [m]. At most about `max_points` wall points a map are used (0: all).
  WallMatch(const OccupancyGrid& map, const OccupancyGrid& truth, double reach, std::size_t max_points);

  PoseEvidence evidence(const mrpt::math::TPose2D& T_truth_map, double tau) const;

  /// Moves the pose so that walls meet: Gauss-Newton on both distance fields, walls further apart than about `sigma`
  /// [m] pull less and less (Geman-McClure weights).
  mrpt::math::TPose2D refine(mrpt::math::TPose2D T_truth_map, double sigma, int iterations) const;

  const mrpt::math::TPoint2D& map_centre() const { return map_.centre; }

 private:
  struct Side {
    Side(const OccupancyGrid& grid, double reach, std::size_t max_points);
    OccupancyGrid grid;
    WallField field;
    std::vector<mrpt::math::TPoint2D> walls;
    std::vector<mrpt::math::TPoint2D> free;
    mrpt::math::TPoint2D centre;  ///< of the wall points
  };
  Side map_;
  Side truth_;
};

}  // namespace rubble::scoring
