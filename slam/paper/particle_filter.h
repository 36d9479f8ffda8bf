#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <vector>

#include "base/angle.h"
#include "base/pose_covariance.h"
#include "base/rng.h"
#include "slam/grid/count_map.h"

namespace rubble::slam {

/// One hypothesis of the robot's pose.
struct Particle {
  mrpt::math::TPose2D T_map_base;
  double weight = 0.0;
};
using Particles = std::vector<Particle>;

/// The three error sources of section III.B, Fig. 5, and one of ours, each the standard deviation of a Gaussian.
struct MotionError {
  double rotation = 0.05;                  ///< initial rotation error, share of the turn
  double heading_per_m = deg_to_rad(5.0);  ///< rotation error while driving [rad/m]
  double distance = 0.15;                  ///< translation error, share of the distance
  double distance_per_rad = 0.0;           ///< translation error while turning, in x and in y [m/rad]; the paper: none
};

/// `count` particles at one pose, all of the same weight.
Particles particles_at(const mrpt::math::TPose2D& T_map_base, int count);

/// Goes down the list sorted by weight and gives each particle round(N w + 0.5) children until N are filled. Weights
/// must be normalised. The children keep the order of their parents and carry the weight 1 / N.
/// (The paper leaves the rounding open; a plain round(N w) lets the cloud diverge where weights are nearly flat.)
Particles resample(Particles particles);

/// Moves each particle by the odometry `T_last_now` along its own heading, with errors drawn from `rng`.
/// No motion: no error.
Particles drift(Particles particles, const mrpt::math::TPose2D& T_last_now, const MotionError& error, Rng& rng);

/// Weights each particle by the sum of p_occ, in 1/255, at the cells its beams end in (eq. 2); unseen cells and those
/// outside the map add nothing. `hits` in the base frame.
Particles measure(Particles particles, const std::vector<mrpt::math::TPoint2D>& hits, const CountMap& map);

/// Divides by the sum of the weights; uniform when all are zero (nothing known was in sight).
Particles normalise(Particles particles);

/// Mean pose of the heaviest `share` of the particles (at least one), circular in the angle. Ties: lower index first.
mrpt::math::TPose2D mean_of_best(const Particles& particles, double share);

/// Weighted covariance of the poses: x, y [m^2], heading [rad^2]. Zero without particles.
PoseCovariance spread(const Particles& particles);

}  // namespace rubble::slam
