#pragma once

#include <mrpt/math/TPoint2D.h>

#include <algorithm>
#include <vector>

#include "base/grid.h"
#include "explore/plan/traversable.h"

namespace rubble::explore {

/// Occupied cells that belong together.
struct Thing {
  std::vector<Cell> cells;
  Cell low;   ///< of the box around it
  Cell high;  ///< inside it
  int longer_side() const { return std::max(high.x - low.x, high.y - low.y); }
  /// [cells]
  mrpt::math::TPoint2D middle() const { return {0.5 * (low.x + high.x), 0.5 * (low.y + high.y)}; }
};

/// What is occupied, cells up to `gap` apart in one thing; in the order of their first cells.
std::vector<Thing> things_of(const OccupancyGrid& cells, int gap);

/// Makes a thing free, as one that can be pushed.
void loosen(Traversable& floor, const Thing& thing);
/// Makes a thing free, as one that may be no thing but the floor of a slope.
void doubt(Traversable& floor, const Thing& thing);

/// Makes free what stands alone and is small, no wider than `extent` [m] and nothing else within 0.15 m: paper that
/// can be pushed aside, as a rule. Says whether there was any.
bool free_small_things(Traversable& floor, double extent);

/// Makes free what stands in a row with gaps that were seen through, at least four pieces no wider than 0.15 m and up
/// to 0.3 m apart: strips that hang from a bar (veil walls), if nothing else can be had. Says whether there was any.
bool free_strips(Traversable& floor);

}  // namespace rubble::explore
