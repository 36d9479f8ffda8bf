#pragma once

#include <string>
#include <vector>

#include "arenas/truth/visible.h"

namespace rubble::arenas {

/// A reason why cells of the truth are not in its visible part, and how many these are.
struct Unseen {
  std::string why;     ///< for people
  double share = 0.0;  ///< of the truth's known cells, 0 to 1
};

/// Explains each cell of `truth` that `visible` (visible_truth by the same viewer) lacks by the first of these that
/// holds: a ray gets there, but a map may show it or not; it shows to a robot that climbs any slope; to one that also
/// climbs steps as high as itself; to one that also fits through any gap; to none of these. Those without a cell are
/// left out, and the shares add up to what `visible` lacks.
std::vector<Unseen> unseen_by_cause(const Arena& arena, const OccupancyGrid& truth, const OccupancyGrid& visible,
                                    const Viewer& viewer = {});

}  // namespace rubble::arenas
