#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <vector>

#include "base/grid.h"
#include "scoring/alignment/feature_verdict.h"
#include "scoring/alignment/match_error.h"
#include "scoring/proposals/features.h"
#include "scoring/rooms/rooms.h"
#include "scoring/walls/warp.h"

namespace rubble::scoring {

/// A place where a wall ends or turns into the floor.
struct CornerFeature {
  mrpt::math::TPoint2D p;  ///< [m]
  double into = 0.0;       ///< direction from the corner into the wall [rad]
  double turn = 0.0;       ///< by which the wall turns there, pi at an end [rad]
};

/// All features of one map, of every kind.
struct MapFeatures {
  FeatureSet surf;
  std::vector<CornerFeature> corners;
  std::vector<Room> rooms;
  std::vector<mrpt::math::TPoint2D> places(EvidenceKind kind) const;
};

/// Without rooms where the map's walls have too many corners for a floor plan.
MapFeatures features_of(const OccupancyGrid& map);

/// E of eq. (7) over one kind of features at a pose, with lambda and C of that kind.
MatchError feature_error(const MapFeatures& map, const MapFeatures& truth, EvidenceKind kind,
                         const mrpt::math::TPose2D& T_truth_map);
/// C of a kind: E where nothing is matched [m^2].
double feature_cap(EvidenceKind kind);

/// What every map of one truth is held against: found once, where there are many.
struct TruthFeatures {
  MapFeatures features;
  std::vector<double> redrawn;  ///< E of each kind between the truth and itself on another raster [m^2]
};
TruthFeatures truth_features(const OccupancyGrid& truth);

/// Every kind of features at the pose, held against what strangers reach.
FeatureVerdict judge_features(const OccupancyGrid& map, const MapFeatures& of_map, const OccupancyGrid& truth,
                              const TruthFeatures& of_truth, const mrpt::math::TPose2D& T_truth_map);

/// Section IV.F from `T_truth_map` on: associations and the least squares fit by turns, while E falls. Corners and SURF
/// features together, so that maps with few of one kind have a pose.
struct FeaturePose {
  mrpt::math::TPose2D T_truth_map;
  double error = 0.0;  ///< mean over both kinds of E / C, 0..1
};
FeaturePose minimise_feature_error(const MapFeatures& map, const MapFeatures& truth,
                                   const mrpt::math::TPose2D& T_truth_map);

/// Eq. (8) as it is printed, over the same features: associations and, given these, b by a linear set of equations.
struct FeatureWarp {
  Warp warp;
  double error = 0.0;       ///< mean over both kinds of E / C after the warp, 0..1
  double size = 0.0;        ///< ||b||: RMS displacement of the features that no rigid transform explains [m]
  std::size_t matched = 0;  ///< pairs it was fitted to
};
/// `frame`: of the map. A polynomial of degree 3 with the ridge of fit_warp(); one that folds the map is held stiffer.
FeatureWarp fit_feature_warp(const MapFeatures& map, const MapFeatures& truth, const mrpt::math::TPose2D& T_truth_map,
                             const GridFrame& frame);

}  // namespace rubble::scoring
