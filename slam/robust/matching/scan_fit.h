#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <vector>

#include "slam/robust/matching/surfel_grid.h"
#include "slam/robust/matching/work.h"

namespace rubble::slam {

/// What is known of a pose before the scan is looked at: a Gaussian about `pose`.
struct PosePrior {
  mrpt::math::TPose2D pose;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< along the axes of `pose`
};

struct ScanFitConfig {
  double sigma = 0.02;         ///< of a point's distance from its surfel's line [m]
  double first_radius = 0.30;  ///< points are paired with surfels at most so far away [m], at first
  double last_radius = 0.12;   ///< and at last
  int iterations = 12;         ///< at most
};

struct ScanFit {
  mrpt::math::TPose2D pose;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the points alone, along the axes of the target's frame
  int paired = 0;                                         ///< points
  double inliers = 0.0;                                   ///< share of points closer than 0.06 m to their surfel's line
  double residual = 0.0;                                  ///< RMS distance of the inliers from their lines [m]
  double prior_chi2 = 0.0;                                ///< squared Mahalanobis distance from the prior
  double cost = 1e9;  ///< robust cost of all points, unpaired ones in full, and of the prior
};

/// Gauss-Newton of point-to-line distances under a Cauchy kernel, with the prior as one more measurement:
/// minimises sum_k rho(n_k . (T p_k - q_k)) / sigma^2 + (T - prior)^T L (T - prior); pairs and kernel tighten from step
/// to step. Where the surfaces leave a direction open (a corridor), the prior alone decides there.
ScanFit fit_scan(const SurfelGrid& target, const std::vector<OrientedPoint>& points, const mrpt::math::TPose2D& start,
                 const PosePrior& prior, const ScanFitConfig& config, Work* work = nullptr);

/// Whether the points alone hold the pose in both directions: what can slide along a wall (a corridor) does not.
bool well_conditioned(const ScanFit& fit);
/// Information with errors added that no match is free of: `sigma_distance` [m], `sigma_angle` [rad].
Eigen::Matrix3d limited(const Eigen::Matrix3d& information, double sigma_distance, double sigma_angle);
/// Covariance or information of a pose along axes from which the ones it is given along are turned by `phi` [rad].
Eigen::Matrix3d turned(const Eigen::Matrix3d& matrix, double phi);

}  // namespace rubble::slam
