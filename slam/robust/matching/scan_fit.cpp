#include "slam/robust/matching/scan_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/angle.h"

namespace rubble::slam {

using mrpt::math::TPose2D;

namespace {

constexpr float kInlier = 0.06F;       ///< [m]
constexpr double kLeastKernel = 0.05;  ///< of the Cauchy weight [m]
constexpr int kLeastFitPairs = 8;
constexpr double kTightening = 0.6;    ///< of the radius, from step to step
constexpr double kLeastAcross = 0.02;  ///< information in the worse direction, of that in the better one
constexpr double kLeastKnown = 150.0;  ///< and at least so much [1/m^2]
constexpr Work kWorkPerPoint = 60;     ///< of pairing one point

/// Sums of one Gauss-Newton step.
struct NormalEquations {
  double xx = 0, xy = 0, xt = 0, yy = 0, yt = 0, tt = 0;
  double bx = 0, by = 0, bt = 0;
  double capped = 0;   ///< of residuals
  double squares = 0;  ///< of the inliers' residuals
  int paired = 0;
  int inliers = 0;

  void add(double nx, double ny, double j, double e, double w) {
    xx += w * nx * nx;
    xy += w * nx * ny;
    xt += w * nx * j;
    yy += w * ny * ny;
    yt += w * ny * j;
    tt += w * j * j;
    bx += w * nx * e;
    by += w * ny * e;
    bt += w * j * e;
    ++paired;
  }
  Eigen::Matrix3d hessian() const {
    Eigen::Matrix3d H;
    H << xx, xy, xt, xy, yy, yt, xt, yt, tt;
    return H;
  }
  Eigen::Vector3d gradient() const { return {bx, by, bt}; }
};

NormalEquations pair_up(const SurfelGrid& target, const std::vector<OrientedPoint>& points, const TPose2D& T,
                        double radius) {
  const auto c = static_cast<float>(std::cos(T.phi));
  const auto s = static_cast<float>(std::sin(T.phi));
  const auto x = static_cast<float>(T.x);
  const auto y = static_cast<float>(T.y);
  const auto per_kernel = static_cast<float>(1.0 / std::max(kLeastKernel, 0.33 * radius));
  NormalEquations sums;
  for (const OrientedPoint& p : points) {
    const float rx = c * p.x - s * p.y;
    const float ry = s * p.x + c * p.y;
    const Surfel* q =
        target.nearest(rx + x, ry + y, c * p.nx - s * p.ny, s * p.nx + c * p.ny, static_cast<float>(radius));
    if (q == nullptr) continue;
    const float e = q->nx * (rx + x - q->x) + q->ny * (ry + y - q->y);
    const float u = e * per_kernel;
    const float w = 1.0F / (1.0F + u * u);
    sums.add(static_cast<double>(q->nx), static_cast<double>(q->ny), static_cast<double>(q->ny * rx - q->nx * ry),
             static_cast<double>(e), static_cast<double>(w));
    if (std::abs(e) < kInlier) {
      ++sums.inliers;
      sums.squares += static_cast<double>(e * e);
      sums.capped += static_cast<double>(e * e / (kInlier * kInlier));
    } else {
      sums.capped += 1.0;
    }
  }
  return sums;
}

}  // namespace

bool well_conditioned(const ScanFit& fit) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(fit.information.topLeftCorner<2, 2>());
  return axes.eigenvalues()[0] >= kLeastAcross * axes.eigenvalues()[1] && axes.eigenvalues()[0] >= kLeastKnown;
}

Eigen::Matrix3d limited(const Eigen::Matrix3d& information, double sigma_distance, double sigma_angle) {
  const double d2 = sigma_distance * sigma_distance;
  const Eigen::Matrix3d floor = Eigen::Vector3d(d2, d2, sigma_angle * sigma_angle).asDiagonal();
  const Eigen::Matrix3d known = information + 1e-6 * Eigen::Matrix3d::Identity();
  return (known.inverse() + floor).inverse();
}

Eigen::Matrix3d turned(const Eigen::Matrix3d& matrix, double phi) {
  const double c = std::cos(phi);
  const double s = std::sin(phi);
  Eigen::Matrix3d R;
  R << c, -s, 0, s, c, 0, 0, 0, 1;
  return R * matrix * R.transpose();
}

ScanFit fit_scan(const SurfelGrid& target, const std::vector<OrientedPoint>& points, const TPose2D& start,
                 const PosePrior& prior, const ScanFitConfig& config, Work* work) {
  ScanFit fit;
  fit.pose = start;
  const Eigen::Matrix3d L = turned(prior.information, prior.pose.phi);
  const double weight = 1.0 / (config.sigma * config.sigma);
  const double count = static_cast<double>(points.size());
  double radius = config.first_radius;
  for (int step = 0; step < config.iterations; ++step) {
    const NormalEquations sums = pair_up(target, points, fit.pose, radius);
    if (work != nullptr) *work += kWorkPerPoint * static_cast<Work>(points.size());
    fit.information = weight * sums.hessian();
    fit.paired = sums.paired;
    fit.inliers = points.empty() ? 0.0 : sums.inliers / count;
    fit.residual = sums.inliers > 0 ? std::sqrt(sums.squares / sums.inliers) : 0.0;
    const Eigen::Vector3d off(fit.pose.x - prior.pose.x, fit.pose.y - prior.pose.y,
                              wrap_angle(fit.pose.phi - prior.pose.phi));
    fit.prior_chi2 = off.dot(L * off);
    fit.cost = 0.5 * (sums.capped + count - sums.paired) + fit.prior_chi2;
    if (sums.paired < kLeastFitPairs) break;

    const Eigen::Vector3d d = (fit.information + L).ldlt().solve(-(weight * sums.gradient() + L * off));
    if (!d.allFinite()) break;
    fit.pose.x += d[0];
    fit.pose.y += d[1];
    fit.pose.phi = wrap_angle(fit.pose.phi + d[2]);
    const bool still = std::abs(d[0]) + std::abs(d[1]) < 1e-3 && std::abs(d[2]) < 5e-4;
    if (still && radius <= config.last_radius + 1e-9) break;
    if (step >= 1 || still) radius = std::max(config.last_radius, kTightening * radius);
  }
  return fit;
}

}  // namespace rubble::slam
