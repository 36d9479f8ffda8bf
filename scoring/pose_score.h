#pragma once

#include <mrpt/math/TPose2D.h>

#include "base/grid.h"
#include "scoring/scorecard.h"

namespace rubble::scoring {

/// Scores `map` at a pose given from outside, without looking for a better one: what a judge sees who lays the maps on
/// each other by hand. `aligned` says that there is a pose, `note` that it was given.
MapScore score_at(const OccupancyGrid& map, const OccupancyGrid& truth, const mrpt::math::TPose2D& T_truth_map,
                  const ScoreConfig& config = {});

/// The same cells on a frame `factor` times as large around the origin of the coordinates.
OccupancyGrid scaled_frame(const OccupancyGrid& map, double factor);

}  // namespace rubble::scoring
