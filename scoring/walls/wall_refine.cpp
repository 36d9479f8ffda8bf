#include <Eigen/Dense>
#include <cmath>

#include "base/rigid.h"
#include "scoring/walls/wall_match.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kStill = 1e-3;  // [m] a step shorter than this ends the refinement

/// Geman-McClure: 1 for walls that meet, falling to a quarter at a distance of sigma.
double pull(double distance, double sigma) {
  const double r = sigma * sigma / (sigma * sigma + distance * distance);
  return r * r;
}

/// Moves the image of `centre_map` by (step_x, step_y) and turns the map about it.
TPose2D stepped(const TPose2D& T, const TPoint2D& centre_map, const TPoint2D& centre, double step_x, double step_y,
                double turn) {
  return turned_onto(centre_map, {centre.x + step_x, centre.y + step_y}, T.phi + turn);
}

}  // namespace

TPose2D WallMatch::refine(const TPose2D& start, double sigma, int iterations) const {
  PlanarTransform T(start);
  for (int i = 0; i < iterations; ++i) {
    const TPoint2D centre = T(map_.centre);
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    const auto add = [&](double gx, double gy, const TPoint2D& q, double d) {
      const double weight = pull(d, sigma);
      const Eigen::Vector3d j(gx, gy, gy * (q.x - centre.x) - gx * (q.y - centre.y));
      a.noalias() += (weight * j) * j.transpose();
      b -= weight * d * j;
    };
    for (const TPoint2D& p : map_.walls) {
      const TPoint2D q = T(p);
      const WallField::Slope f = truth_.field.slope(q);
      if (f.distance < truth_.field.cap()) add(f.gx, f.gy, q, f.distance);
    }
    for (const TPoint2D& q : truth_.walls) {
      const WallField::Slope f = map_.field.slope(T.inverse(q));
      if (f.distance < map_.field.cap())
        add(-(T.cosine() * f.gx - T.sine() * f.gy), -(T.sine() * f.gx + T.cosine() * f.gy), q, f.distance);
    }
    // A ridge of one wall point keeps the step finite where the walls leave a direction free.
    a.diagonal().array() += 1.0;
    const Eigen::Vector3d step = a.ldlt().solve(b);
    if (!step.allFinite()) break;
    T = PlanarTransform(stepped(T.pose(), map_.centre, centre, step.x(), step.y(), step.z()));
    if (step.head<2>().norm() < kStill && std::abs(step.z()) < 0.1 * kStill) break;
  }
  return T.pose();
}

Warp WallMatch::refine(const Warp& start, double sigma, const Stiffness& stiffness, int iterations) const {
  // One solver for all degrees, on the stack: a size known only when it runs costs a fifth of the time to compile.
  constexpr int kMost = 3 + 2 * Warp::kMaxTerms;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMost, kMost>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMost, 1>;
  Warp warp = start;
  const int terms = warp.terms == Warp::kMaxTerms ? Warp::kMaxTerms : 5;
  const int unknowns = 3 + 2 * terms;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const PlanarTransform T = warp.T_truth_map;
    const TPoint2D centre = T(map_.centre);
    Matrix a = Matrix::Zero(unknowns, unknowns);
    Vector b = Vector::Zero(unknowns);
    double total = 0.0;
    // gx, gy: how the residual grows when the map point at p_map moves in the truth frame.
    const auto add = [&](double gx, double gy, const TPoint2D& p_map, const TPoint2D& q, double d) {
      const double weight = pull(d, sigma);
      const TPoint2D g_map = T.turned_back(gx, gy);
      const Warp::Terms phi = warp.terms_at(p_map);
      Vector j(unknowns);
      j(0) = gx;
      j(1) = gy;
      j(2) = gy * (q.x - centre.x) - gx * (q.y - centre.y);
      for (int i = 0; i < terms; ++i) {
        j(3 + i) = g_map.x * phi[static_cast<std::size_t>(i)];
        j(3 + terms + i) = g_map.y * phi[static_cast<std::size_t>(i)];
      }
      // The lower half of weight j j^T, in the order of Eigen's rankUpdate(), which asks for the size at each column.
      for (int column = 0; column < unknowns; ++column) {
        const double scaled = weight * j(column);
        double* const to = a.data() + column * unknowns;
        for (int row = column; row < unknowns; ++row) to[row] += scaled * j(row);
      }
      b -= weight * d * j;
      total += weight;
    };
    for (const TPoint2D& p : map_.walls) {
      const TPoint2D q = warp(p);
      const WallField::Slope f = truth_.field.slope(q);
      if (f.distance < truth_.field.cap()) add(f.gx, f.gy, p, q, f.distance);
    }
    for (const TPoint2D& q : truth_.walls) {
      const TPoint2D p = warp.inverse(q);
      const WallField::Slope f = map_.field.slope(p);
      if (f.distance < map_.field.cap())
        add(-(T.cosine() * f.gx - T.sine() * f.gy), -(T.sine() * f.gx + T.cosine() * f.gy), p, q, f.distance);
    }
    a.diagonal().head<3>().array() += 1.0;
    for (int i = 0; i < terms; ++i) {
      const double ridge = stiffness[static_cast<std::size_t>(Warp::degree_of(i))] * (total + 1.0);
      for (const int row : {3 + i, 3 + terms + i}) a(row, row) += ridge;
      b(3 + i) -= ridge * warp.dx[static_cast<std::size_t>(i)];
      b(3 + terms + i) -= ridge * warp.dy[static_cast<std::size_t>(i)];
    }
    const Vector step = a.selfadjointView<Eigen::Lower>().ldlt().solve(b);
    if (!step.allFinite()) break;
    warp.T_truth_map = PlanarTransform(stepped(T.pose(), map_.centre, centre, step(0), step(1), step(2)));
    for (int i = 0; i < terms; ++i) {
      warp.dx[static_cast<std::size_t>(i)] += step(3 + i);
      warp.dy[static_cast<std::size_t>(i)] += step(3 + terms + i);
    }
    if (step.norm() < 1e-3) break;
  }
  return warp;
}

}  // namespace rubble::scoring
