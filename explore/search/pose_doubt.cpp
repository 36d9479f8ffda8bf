#include "explore/search/pose_doubt.h"

#include <algorithm>

namespace rubble::explore {
namespace {

constexpr double kUnsure = 0.40;   ///< a pose that has lost so much places nothing [m]
constexpr double kUsual = 0.0025;  ///< variance forgiven: driving costs less between two closed loops [m^2/s]

double variance(const PoseCovariance& covariance) { return covariance(0, 0) + covariance(1, 1); }

/// Of the place `to`, rigidly attached to the pose `from`.
double variance_at(const PoseCovariance& covariance, const mrpt::math::TPose2D& from, const mrpt::math::TPose2D& to) {
  const double dx = to.x - from.x;
  const double dy = to.y - from.y;
  return variance(covariance) + 2.0 * (dx * covariance(1, 2) - dy * covariance(0, 2)) +
         (dx * dx + dy * dy) * covariance(2, 2);
}

}  // namespace

void PoseDoubt::update(const mrpt::math::TPose2D& T_map_base, const PoseCovariance& covariance, double dt) {
  usual_ += kUsual * dt;
  lost_ = std::max(0.0, variance(covariance) - variance_at(covariance_, reference_, T_map_base) - usual_);
  if (lost_ > 0.0) return;
  reference_ = T_map_base;
  covariance_ = covariance;
  usual_ = 0.0;
}

bool PoseDoubt::unsure() const { return lost_ > kUnsure * kUnsure; }

}  // namespace rubble::explore
