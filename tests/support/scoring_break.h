#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include "base/angle.h"
#include "base/grid.h"
#include "tests/support/scoring_maze.h"

/// Maps that came apart.
namespace rubble::scoring::testing {

/// What lies east of `seam` [m] drawn as `T` moves it, as after a loop that was not closed. Where the parts overlap the
/// later one was drawn over the earlier.
inline OccupancyGrid come_apart(const OccupancyGrid& truth, double seam, const mrpt::math::TPose2D& T) {
  OccupancyGrid out = padded(truth, 20);
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const mrpt::math::TPoint2D p = out.centre({x, y});
      const mrpt::math::TPoint2D moved = T.inverseComposePoint(p);
      const Cell east = truth.cell(moved);
      const Cell west = truth.cell(p);
      out[{x, y}] = Occupancy::Unknown;
      if (p.x < seam && truth.inside(west)) out[{x, y}] = truth[west];
      if (moved.x >= seam && truth.inside(east) && truth[east] != Occupancy::Unknown) out[{x, y}] = truth[east];
    }
  return out;
}

/// A turn about a point of the seam, and a shift.
inline mrpt::math::TPose2D about(const mrpt::math::TPoint2D& p, double deg, double dx, double dy) {
  const mrpt::math::TPose2D turn(0.0, 0.0, deg_to_rad(deg));
  const mrpt::math::TPoint2D moved = turn.composePoint(p);
  return {p.x - moved.x + dx, p.y - moved.y + dy, turn.phi};
}

}  // namespace rubble::scoring::testing
