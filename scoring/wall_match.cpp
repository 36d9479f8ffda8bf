#include "scoring/wall_match.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kSample = 0.25;  // spacing of area samples [m]

Occupancy at(const OccupancyGrid& grid, const TPoint2D& p) {
  const Cell c = grid.cell(p);
  return grid.inside(c) ? grid[c] : Occupancy::Unknown;
}

/// Every n-th point of each row-major run, so that all parts of the map keep their share.
std::vector<TPoint2D> thin_out(const std::vector<TPoint2D>& points, std::size_t max_points) {
  if (max_points == 0 || points.size() <= max_points) return points;
  std::vector<TPoint2D> out;
  out.reserve(max_points);
  const double step = static_cast<double>(points.size()) / static_cast<double>(max_points);
  for (std::size_t i = 0; i < max_points; ++i)
    out.push_back(points[static_cast<std::size_t>((static_cast<double>(i) + 0.5) * step)]);
  return out;
}

/// Returns the area one sample stands for [m^2].
double sample_known(const OccupancyGrid& grid, std::vector<TPoint2D>& free, std::vector<TPoint2D>& known) {
  const int step = std::max(1, static_cast<int>(std::lround(kSample / grid.resolution())));
  for (int y = step / 2; y < grid.height(); y += step) {
    for (int x = step / 2; x < grid.width(); x += step) {
      const Occupancy here = grid[{x, y}];
      if (here == Occupancy::Free) free.push_back(grid.centre({x, y}));
      if (here != Occupancy::Unknown) known.push_back(grid.centre({x, y}));
    }
  }
  return step * step * grid.resolution() * grid.resolution();
}

double ratio(double a, double b) { return b > 0.0 ? a / b : 0.0; }

/// How the wall points of one map fare on the other.
template <class Transform>
WallEvidence tally(const std::vector<TPoint2D>& walls, const OccupancyGrid& other, const WallField& field, double tau,
                   const Transform& transform) {
  double known = 0.0;
  double met = 0.0;
  double contradicted = 0.0;
  for (const TPoint2D& p : walls) {
    const TPoint2D q = transform(p);
    const double d = field.distance(q);
    const Occupancy there = at(other, q);
    if (there == Occupancy::Unknown && d >= tau) continue;
    known += 1.0;
    met += std::max(0.0, 1.0 - d / tau);
    if (there == Occupancy::Free && d >= tau) contradicted += 1.0;
  }
  WallEvidence out;
  out.known = ratio(known, static_cast<double>(walls.size()));
  out.met = ratio(met, known);
  out.contradicted = ratio(contradicted, known);
  return out;
}

/// Mean k(d) over what a map knows: what a random wall would find.
double chance(const std::vector<TPoint2D>& known, const WallField& field, double tau) {
  double met = 0.0;
  for (const TPoint2D& p : known) met += std::max(0.0, 1.0 - field.distance(p) / tau);
  return ratio(met, static_cast<double>(known.size()));
}

/// Normal equations of one Gauss-Newton step in (dx, dy, dphi) about a centre in truth coordinates.
struct Normal {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  void add(double gx, double gy, const TPoint2D& arm, double d, double sigma) {
    const double s = sigma * sigma / (sigma * sigma + d * d);
    const double weight = s * s;
    const Eigen::Vector3d j(gx, gy, -gx * arm.y + gy * arm.x);
    a += weight * j * j.transpose();
    b -= weight * d * j;
  }
};

}  // namespace

WallMatch::Side::Side(const OccupancyGrid& source, double reach, std::size_t max_points)
    : grid(source), field(source, reach), walls(thin_out(wall_points(source), max_points)) {
  sample_area = sample_known(source, free, known);
  if (walls.empty()) return;
  for (const TPoint2D& p : walls) centre += p;
  centre *= 1.0 / static_cast<double>(walls.size());
  double sum = 0.0;
  for (const TPoint2D& p : walls) sum += (p - centre).sqrNorm();
  extent = std::max(1.0, 2.0 * std::sqrt(sum / static_cast<double>(walls.size())));
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (const TPoint2D& p : walls) {
    const TPoint2D d = p - centre;
    xx += d.x * d.x;
    xy += d.x * d.y;
    yy += d.y * d.y;
  }
  const double n = static_cast<double>(walls.size());
  // The smaller eigenvalue of the covariance.
  const double variance = 0.5 * (xx + yy - std::sqrt((xx - yy) * (xx - yy) + 4.0 * xy * xy)) / n;
  breadth = std::sqrt(std::max(0.0, variance));
}

WallMatch::WallMatch(const OccupancyGrid& map, const OccupancyGrid& truth, double reach, std::size_t max_points)
    : map_(map, reach, max_points), truth_(truth, reach, max_points) {}

WallMatch::Kernel WallMatch::kernel(double tau) const {
  return {tau, chance(truth_.known, truth_.field, tau), chance(map_.known, map_.field, tau)};
}

PoseEvidence WallMatch::evidence(const Warp& warp, const Kernel& kernel) const {
  const double tau = kernel.tau;
  PoseEvidence out;
  out.map = tally(map_.walls, truth_.grid, truth_.field, tau, [&](const TPoint2D& p) { return warp.forward(p); });
  out.truth = tally(truth_.walls, map_.grid, map_.field, tau, [&](const TPoint2D& p) { return warp.inverse(p); });
  out.map.chance = kernel.truth_chance;
  out.truth.chance = kernel.map_chance;
  double common = 0.0;
  for (const TPoint2D& p : map_.free)
    if (at(truth_.grid, warp.forward(p)) == Occupancy::Free) common += 1.0;
  out.free_common = std::min(1.0, ratio(common * map_.sample_area, std::min(map_.free_area(), truth_.free_area())));
  return out;
}

TPose2D WallMatch::refine(TPose2D T_truth_map, double sigma, int iterations) const {
  for (int i = 0; i < iterations; ++i) {
    const TPoint2D centre = T_truth_map.composePoint(map_.centre);
    const double c = std::cos(T_truth_map.phi);
    const double s = std::sin(T_truth_map.phi);
    Normal normal;
    for (const TPoint2D& p : map_.walls) {
      const TPoint2D q(c * p.x - s * p.y + T_truth_map.x, s * p.x + c * p.y + T_truth_map.y);
      const WallField::Slope f = truth_.field.slope(q);
      if (f.distance < truth_.field.cap()) normal.add(f.gx, f.gy, q - centre, f.distance, sigma);
    }
    for (const TPoint2D& q : truth_.walls) {
      const double dx = q.x - T_truth_map.x;
      const double dy = q.y - T_truth_map.y;
      const WallField::Slope f = map_.field.slope({c * dx + s * dy, -s * dx + c * dy});
      if (f.distance < map_.field.cap())
        normal.add(-(c * f.gx - s * f.gy), -(s * f.gx + c * f.gy), q - centre, f.distance, sigma);
    }
    // A ridge of one wall point keeps the step finite where the walls leave a direction free.
    normal.a.diagonal().array() += 1.0;
    const Eigen::Vector3d step = normal.a.ldlt().solve(normal.b);
    if (!step.allFinite()) break;
    const TPoint2D moved(centre.x + step.x(), centre.y + step.y());
    T_truth_map.phi += step.z();
    const TPoint2D turned = TPose2D(0.0, 0.0, T_truth_map.phi).composePoint(map_.centre);
    T_truth_map.x = moved.x - turned.x;
    T_truth_map.y = moved.y - turned.y;
    if (step.head<2>().norm() < 1e-4 && std::abs(step.z()) < 1e-5) break;
  }
  return T_truth_map;
}

Warp WallMatch::rigid(const TPose2D& T_truth_map) const {
  Warp warp;
  warp.T_truth_map = T_truth_map;
  warp.centre = map_.centre;
  warp.extent = map_.extent;
  return warp;
}

Warp WallMatch::refine(Warp warp, double sigma, double stiffness, int iterations) const {
  constexpr int kTerms = Warp::kTerms;
  constexpr int kUnknowns = 3 + 2 * kTerms;
  using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const TPoint2D centre = warp.T_truth_map.composePoint(map_.centre);
    const double c = std::cos(warp.T_truth_map.phi);
    const double s = std::sin(warp.T_truth_map.phi);
    Matrix a = Matrix::Zero();
    Vector b = Vector::Zero();
    double total = 0.0;
    // gx, gy: how the residual grows when the map point at p_map moves in the truth frame.
    const auto add = [&](double gx, double gy, const TPoint2D& p_map, const TPoint2D& q, double d) {
      const double r = sigma * sigma / (sigma * sigma + d * d);
      const double weight = r * r;
      const double map_gx = c * gx + s * gy;
      const double map_gy = -s * gx + c * gy;
      const auto phi = Warp::terms((p_map.x - warp.centre.x) / warp.extent, (p_map.y - warp.centre.y) / warp.extent);
      Vector j;
      j(0) = gx;
      j(1) = gy;
      j(2) = -gx * (q.y - centre.y) + gy * (q.x - centre.x);
      for (int i = 0; i < kTerms; ++i) {
        j(3 + i) = map_gx * phi[static_cast<std::size_t>(i)];
        j(3 + kTerms + i) = map_gy * phi[static_cast<std::size_t>(i)];
      }
      a.selfadjointView<Eigen::Lower>().rankUpdate(j, weight);
      b -= weight * d * j;
      total += weight;
    };
    for (const TPoint2D& p : map_.walls) {
      const TPoint2D q = warp.forward(p);
      const WallField::Slope f = truth_.field.slope(q);
      if (f.distance < truth_.field.cap()) add(f.gx, f.gy, p, q, f.distance);
    }
    for (const TPoint2D& q : truth_.walls) {
      const TPoint2D p = warp.inverse(q);
      const WallField::Slope f = map_.field.slope(p);
      if (f.distance < map_.field.cap()) add(-(c * f.gx - s * f.gy), -(s * f.gx + c * f.gy), p, q, f.distance);
    }
    a.diagonal().head<3>().array() += 1.0;
    for (int i = 0; i < kTerms; ++i) {
      const double ridge = stiffness * (total + 1.0);
      a(3 + i, 3 + i) += ridge;
      a(3 + kTerms + i, 3 + kTerms + i) += ridge;
      b(3 + i) -= ridge * warp.dx[static_cast<std::size_t>(i)];
      b(3 + kTerms + i) -= ridge * warp.dy[static_cast<std::size_t>(i)];
    }
    const Vector step = a.selfadjointView<Eigen::Lower>().ldlt().solve(b);
    if (!step.allFinite()) break;
    const TPoint2D moved(centre.x + step(0), centre.y + step(1));
    warp.T_truth_map.phi += step(2);
    const TPoint2D turned = TPose2D(0.0, 0.0, warp.T_truth_map.phi).composePoint(map_.centre);
    warp.T_truth_map.x = moved.x - turned.x;
    warp.T_truth_map.y = moved.y - turned.y;
    for (int i = 0; i < kTerms; ++i) {
      warp.dx[static_cast<std::size_t>(i)] += step(3 + i);
      warp.dy[static_cast<std::size_t>(i)] += step(3 + kTerms + i);
    }
    if (step.norm() < 1e-3) break;
  }
  return warp;
}

TPose2D WallMatch::nearest_rigid(const Warp& warp) const {
  TPoint2D mean_map(0.0, 0.0);
  TPoint2D mean_truth(0.0, 0.0);
  const double n = static_cast<double>(map_.walls.size());
  for (const TPoint2D& p : map_.walls) {
    mean_map += p;
    mean_truth += warp.forward(p);
  }
  mean_map *= 1.0 / n;
  mean_truth *= 1.0 / n;
  double dot = 0.0;
  double cross = 0.0;
  for (const TPoint2D& p : map_.walls) {
    const TPoint2D a = p - mean_map;
    const TPoint2D b = warp.forward(p) - mean_truth;
    dot += a.x * b.x + a.y * b.y;
    cross += a.x * b.y - a.y * b.x;
  }
  const double phi = std::atan2(cross, dot);
  const TPoint2D turned = TPose2D(0.0, 0.0, phi).composePoint(mean_map);
  return {mean_truth.x - turned.x, mean_truth.y - turned.y, phi};
}

double WallMatch::bend(const Warp& warp) const {
  const TPose2D T = nearest_rigid(warp);
  double sum = 0.0;
  for (const TPoint2D& p : map_.walls) sum += (warp.forward(p) - T.composePoint(p)).sqrNorm();
  return std::sqrt(ratio(sum, static_cast<double>(map_.walls.size())));
}

}  // namespace rubble::scoring
