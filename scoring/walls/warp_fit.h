#pragma once

#include "scoring/walls/overlap.h"
#include "scoring/walls/wall_match.h"
#include "scoring/walls/warp.h"

namespace rubble::scoring {

struct WarpConfig {
  int degree = 3;
  double stiffness = 0.0005;      ///< ridge of the linear non-rigid terms; doubled for each degree more
  double intolerable = 2.0;       ///< RMS displacement for which the penalty takes everything [m]
  std::size_t max_points = 1500;  ///< wall points of each map that pull
};

/// What a map would score if its distortion were undone, and how large that is: eq. (8).
struct WarpedScore {
  Warp warp;
  Overlap overlap;    ///< after the warp; never below the rigid one
  double size = 0.0;  ///< ||b||: RMS displacement of the map's walls that no rigid transform explains [m]
  double kept = 1.0;  ///< what the penalty for it leaves of a score: 1 - size / intolerable, at least 0
};

/// Fits a polynomial displacement beside the pose, stiffly first. One that folds the map (Jacobian not above 0 anywhere
/// on it) or does not raise the overlap is not used: then the warp is rigid and its size 0.
WarpedScore fit_warp(const OccupancyGrid& map, const OccupancyGrid& truth, const WallOverlap& walls,
                     const mrpt::math::TPose2D& T_truth_map, const WarpConfig& config = {});

/// The displacement nowhere folds the map: det J > 0 on a grid over it, 1 m apart.
bool keeps_order(const Warp& warp, const GridFrame& frame);

}  // namespace rubble::scoring
