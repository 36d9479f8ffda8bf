#include "scoring/wall_match.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kFreeSample = 0.3;  // [m]

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

std::vector<TPoint2D> free_samples(const OccupancyGrid& grid) {
  std::vector<TPoint2D> out;
  const int step = std::max(1, static_cast<int>(std::lround(kFreeSample / grid.resolution())));
  for (int y = step / 2; y < grid.height(); y += step)
    for (int x = step / 2; x < grid.width(); x += step)
      if (grid[{x, y}] == Occupancy::Free) out.push_back(grid.centre({x, y}));
  return out;
}

double ratio(double a, double b) { return b > 0.0 ? a / b : 0.0; }

struct WallTally {
  double known = 0.0;
  double met = 0.0;
  double contradicted = 0.0;
};

/// How the wall points of one map fare on the other.
template <class Transform>
WallTally tally(const std::vector<TPoint2D>& walls, const OccupancyGrid& other, const WallField& field, double tau,
                const Transform& transform) {
  WallTally out;
  for (const TPoint2D& p : walls) {
    const TPoint2D q = transform(p);
    const double d = field.distance(q);
    const Occupancy there = at(other, q);
    if (there == Occupancy::Unknown && d >= tau) continue;
    out.known += 1.0;
    out.met += std::max(0.0, 1.0 - d / tau);
    if (there == Occupancy::Free && d >= tau) out.contradicted += 1.0;
  }
  return out;
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
    : grid(source), field(source, reach), walls(thin_out(wall_points(source), max_points)), free(free_samples(source)) {
  for (const TPoint2D& p : walls) centre += p;
  if (!walls.empty()) centre *= 1.0 / static_cast<double>(walls.size());
}

WallMatch::WallMatch(const OccupancyGrid& map, const OccupancyGrid& truth, double reach, std::size_t max_points)
    : map_(map, reach, max_points), truth_(truth, reach, max_points) {}

PoseEvidence WallMatch::evidence(const TPose2D& T_truth_map, double tau) const {
  const WallTally from_map =
      tally(map_.walls, truth_.grid, truth_.field, tau, [&](const TPoint2D& p) { return T_truth_map.composePoint(p); });
  const WallTally from_truth = tally(truth_.walls, map_.grid, map_.field, tau,
                                     [&](const TPoint2D& p) { return T_truth_map.inverseComposePoint(p); });
  double common = 0.0;
  for (const TPoint2D& p : map_.free)
    if (at(truth_.grid, T_truth_map.composePoint(p)) == Occupancy::Free) common += 1.0;

  PoseEvidence out;
  out.map_walls = ratio(from_map.known, static_cast<double>(map_.walls.size()));
  out.truth_walls = ratio(from_truth.known, static_cast<double>(truth_.walls.size()));
  out.map_met = ratio(from_map.met, from_map.known);
  out.truth_met = ratio(from_truth.met, from_truth.known);
  out.map_contradicted = ratio(from_map.contradicted, from_map.known);
  out.truth_contradicted = ratio(from_truth.contradicted, from_truth.known);
  out.free_common = ratio(common, static_cast<double>(std::min(map_.free.size(), truth_.free.size())));
  out.score = out.map_walls * (out.map_met - 0.4 - 0.5 * out.map_contradicted) +
              out.truth_walls * (out.truth_met - 0.4 - 0.5 * out.truth_contradicted);
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

}  // namespace rubble::scoring
