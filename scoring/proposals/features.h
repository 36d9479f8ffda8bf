#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <opencv2/core.hpp>
#include <vector>

#include "base/grid.h"
#include "scoring/proposals/feature_kind.h"

namespace rubble::scoring {

/// A distinctive place of a map, f_i of eq. (7).
struct Feature {
  mrpt::math::TPoint2D p;  ///< in the map's frame [m]
  double size = 0.0;       ///< of the neighbourhood that the descriptor tells about [m]
  double angle = 0.0;      ///< dominant direction there, counter-clockwise from x [rad]
};

/// Features of one map, strongest first, and their descriptors: one row each, CV_32F (SURF) or CV_8U bits.
struct FeatureSet {
  FeatureKind kind = FeatureKind::Surf;
  std::vector<Feature> features;
  cv::Mat descriptors;
  bool binary() const { return descriptors.depth() == CV_8U; }
};

struct FeatureConfig {
  double cell = 0.05;              ///< pixel of the image that features are found in [m]; fixes the scale
  double blur = 0.075;             ///< standard deviation of its smoothing [m]
  std::size_t max_features = 800;  ///< strongest ones kept
};

/// Finds the features of a map drawn as a grey image: walls dark, free light, unknown between. SURF: Bay 2006, from
/// dlib; AKAZE: Alcantarilla 2013 and ORB: Rublee 2011, from OpenCV. Deterministic. None on an empty map.
FeatureSet find_features(const OccupancyGrid& grid, FeatureKind kind, const FeatureConfig& config = {});

/// Difference of two descriptors: Euclidean for SURF (0..2), share of differing bits else.
double descriptor_distance(const FeatureSet& a, std::size_t i, const FeatureSet& b, std::size_t j);

}  // namespace rubble::scoring
