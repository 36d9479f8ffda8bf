#include "scoring/walls/wall_match.h"

#include <algorithm>
#include <cmath>

#include "base/grid.h"
#include "base/rigid.h"
#include "scoring/walls/overlap.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kSample = 0.25;  // spacing of area samples [m]

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
    const Occupancy there = occupancy_at(other, q);
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

/// Length of wall that each of the points stands for [m].
double length_of_each(const std::vector<TPoint2D>& walls, const OccupancyGrid& grid) {
  const auto cells = static_cast<double>(std::count(grid.cells().begin(), grid.cells().end(), Occupancy::Occupied));
  return ratio(cells * grid.resolution() * grid.resolution(),
               2.0 * wall_half_thickness(grid) * static_cast<double>(walls.size()));
}

/// Mean k(d) over what a map knows: what a random wall would find.
double chance(const std::vector<TPoint2D>& known, const WallField& field, double tau) {
  double met = 0.0;
  for (const TPoint2D& p : known) met += std::max(0.0, 1.0 - field.distance(p) / tau);
  return ratio(met, static_cast<double>(known.size()));
}

}  // namespace

WallMatch::Side::Side(const OccupancyGrid& source, double reach, std::size_t max_points)
    : grid(source), field(source, reach), walls(thin_out(wall_points(source), max_points)) {
  const double sample_area = sample_known(source, free, known);
  free_area = sample_area * static_cast<double>(free.size());
  free = thin_out(free, kMaxSamples);
  known = thin_out(known, kMaxSamples);
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
  out.map = tally(map_.walls, truth_.grid, truth_.field, tau, [&](const TPoint2D& p) { return warp(p); });
  out.truth = tally(truth_.walls, map_.grid, map_.field, tau, [&](const TPoint2D& p) { return warp.inverse(p); });
  out.map.chance = kernel.truth_chance;
  out.truth.chance = kernel.map_chance;
  double common = 0.0;
  for (const TPoint2D& p : map_.free)
    if (occupancy_at(truth_.grid, warp(p)) == Occupancy::Free) common += 1.0;
  out.common_area = common * ratio(map_.free_area, static_cast<double>(map_.free.size()));
  out.free_common = std::min(1.0, ratio(out.common_area, std::min(map_.free_area, truth_.free_area)));
  return out;
}

std::vector<WallDuel> WallMatch::duels(const Placement& ours, const std::vector<Placement>& others, double tau) const {
  const double map_length = length_of_each(map_.walls, map_.grid);
  const double truth_length = length_of_each(truth_.walls, truth_.grid);
  const GridFrame& f = map_.grid.frame();
  const double twice_the_axis = 2.0 * f.x0 + f.width * f.resolution;
  const auto turned_over = [&](const TPoint2D& p, bool mirrored) {
    return mirrored ? TPoint2D(twice_the_axis - p.x, p.y) : p;
  };
  std::vector<WallDuel> out;
  for (const Placement& theirs : others) {
    WallDuel duel;
    const auto ask = [&](const Side& other, const TPoint2D& at_ours, const TPoint2D& at_theirs, double length) {
      const auto met = [&](const TPoint2D& p) { return std::max(0.0, 1.0 - other.field.distance(p) / tau); };
      const double here = met(at_ours);
      const double there = met(at_theirs);
      if (here == 0.0 && occupancy_at(other.grid, at_ours) == Occupancy::Unknown) return;
      if (there == 0.0 && occupancy_at(other.grid, at_theirs) == Occupancy::Unknown) return;
      (here > there ? duel.ours : duel.theirs) += length * std::abs(here - there);
    };
    const PlanarTransform T_ours(ours.T_truth_map);
    const PlanarTransform T_theirs(theirs.T_truth_map);
    for (const TPoint2D& p : map_.walls)
      ask(truth_, T_ours(turned_over(p, ours.mirrored)), T_theirs(turned_over(p, theirs.mirrored)), map_length);
    for (const TPoint2D& q : truth_.walls)
      ask(map_, turned_over(T_ours.inverse(q), ours.mirrored), turned_over(T_theirs.inverse(q), theirs.mirrored),
          truth_length);
    out.push_back(duel);
  }
  return out;
}

Warp WallMatch::rigid(const TPose2D& T_truth_map, int degree) const {
  Warp warp;
  warp.terms = Warp::terms_of(degree);
  warp.T_truth_map = PlanarTransform(T_truth_map);
  warp.centre = map_.centre;
  warp.extent = map_.extent;
  return warp;
}

TPose2D WallMatch::nearest_rigid(const Warp& warp, double met) const {
  std::vector<TPoint2D> from;
  std::vector<TPoint2D> to;
  for (const TPoint2D& p : map_.walls) {
    const TPoint2D q = warp(p);
    if (met < kEverywhere && truth_.field.distance(q) >= met) continue;
    from.push_back(p);
    to.push_back(q);
  }
  if (from.empty()) return nearest_rigid(warp);
  return fit_rigid(from, to);
}

TPose2D WallMatch::halfway(const TPose2D& a, const TPose2D& b) const {
  const PlanarTransform to_a(a);
  const PlanarTransform to_b(b);
  std::vector<TPoint2D> to;
  for (const TPoint2D& p : map_.walls) to.push_back((to_a(p) + to_b(p)) * 0.5);
  return fit_rigid(map_.walls, to);
}

double WallMatch::bend(const Warp& warp) const {
  const PlanarTransform T(nearest_rigid(warp));
  double sum = 0.0;
  for (const TPoint2D& p : map_.walls) sum += (warp(p) - T(p)).sqrNorm();
  return std::sqrt(ratio(sum, static_cast<double>(map_.walls.size())));
}

}  // namespace rubble::scoring
