#include "scoring/walls/overlap.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/angle.h"
#include "base/planar.h"
#include "scoring/walls/wall_field.h"

namespace rubble::scoring {
namespace {

bool known(const OccupancyGrid& grid, const mrpt::math::TPoint2D& p) {
  const Cell c = grid.cell(p);
  return grid.inside(c) && grid[c] != Occupancy::Unknown;
}

constexpr double kThickest = 0.3;  ///< half of what is built [m]

/// Not zero in wall that is thicker than any that is built, as where a plan fills what lies outside with black: it has
/// faces, but no thickness.
Grid<unsigned char> solid_masses(const OccupancyGrid& grid) {
  Grid<unsigned char> out(grid.frame());
  if (grid.width() == 0 || grid.height() == 0) return out;
  const auto reach = static_cast<float>(kThickest / grid.resolution());
  cv::Mat walls(grid.height(), grid.width(), CV_8U);
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x)
      walls.at<unsigned char>(y, x) = grid[{x, y}] == Occupancy::Occupied ? 255 : 0;
  if (cv::countNonZero(walls) == grid.width() * grid.height()) return out;  // nothing has a face
  cv::Mat depth, off;
  cv::distanceTransform(walls, depth, cv::DIST_L2, cv::DIST_MASK_5);
  const cv::Mat core = depth > reach;
  if (cv::countNonZero(core) == 0) return out;
  cv::distanceTransform(255 - core, off, cv::DIST_L2, cv::DIST_MASK_5);
  const cv::Mat masses = (off <= reach + 1.5F) & walls;
  for (int y = 0; y < grid.height(); ++y) std::copy_n(masses.ptr<unsigned char>(y), grid.width(), out.row(y));
  return out;
}

}  // namespace

double wall_half_thickness(const OccupancyGrid& grid) {
  const Grid<unsigned char> masses = solid_masses(grid);
  const auto occupied = [&](int x, int y) { return grid.inside({x, y}) && grid[{x, y}] == Occupancy::Occupied; };
  bool has_walls = false;
  std::size_t area = 0;
  std::size_t straight = 0;
  std::size_t diagonal = 0;
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      if (grid[{x, y}] != Occupancy::Occupied) continue;
      has_walls = true;
      if (masses[{x, y}] != 0) continue;
      ++area;
      straight += (occupied(x - 1, y) ? 0u : 1u) + (occupied(x + 1, y) ? 0u : 1u) + (occupied(x, y - 1) ? 0u : 1u) +
                  (occupied(x, y + 1) ? 0u : 1u);
      diagonal += (occupied(x - 1, y - 1) ? 0u : 1u) + (occupied(x + 1, y + 1) ? 0u : 1u) +
                  (occupied(x - 1, y + 1) ? 0u : 1u) + (occupied(x + 1, y - 1) ? 0u : 1u);
    }
  }
  if (area == 0) return has_walls ? kThickest : 0.0;
  const double boundary = kPi / 8.0 * (static_cast<double>(straight) + static_cast<double>(diagonal) / std::sqrt(2.0));
  return grid.resolution() * static_cast<double>(area) / boundary;
}

WallOverlap::Side::Side(const OccupancyGrid& source, double tau)
    : grid(&source),
      field(source, tau + source.resolution()),
      walls(wall_points(source)),
      half_thickness(wall_half_thickness(source)) {
  const double area = source.resolution() * source.resolution();
  cell_length = half_thickness > 0.0 ? area / (2.0 * half_thickness) : 0.0;
}

/// From a point to the nearest wall cell, not to its centre: what lies on a wall cell is on the wall.
double WallOverlap::Side::kernel(const mrpt::math::TPoint2D& p, double tau) const {
  const double distance = std::max(0.0, field.distance(p) - 0.5 * grid->resolution()) + excess;
  return std::clamp(1.0 - distance / tau, 0.0, 1.0);
}

WallOverlap::WallOverlap(const OccupancyGrid& map, const OccupancyGrid& truth, double tau)
    : tau_(tau), map_(map, tau), truth_(truth, tau) {
  const double excess = map_.half_thickness - truth_.half_thickness;
  map_.excess = std::max(0.0, excess);
  truth_.excess = std::max(0.0, -excess);
}

template <class Transform, class Take>
void WallOverlap::visit_map(const Transform& T, const Take& take) const {
  for (const mrpt::math::TPoint2D& p_map : map_.walls) {
    const mrpt::math::TPoint2D p_truth = T(p_map);
    if (known(*truth_.grid, p_truth)) take(p_truth, truth_.kernel(p_truth, tau_));
  }
}

template <class Transform, class Take>
void WallOverlap::visit_truth(const Transform& T, const Take& take) const {
  for (const mrpt::math::TPoint2D& p_truth : truth_.walls) take(p_truth, map_.kernel(T.inverse(p_truth), tau_));
}

template <class Transform>
Overlap WallOverlap::measure(const Transform& T) const {
  Overlap out;
  double sum = 0.0;
  visit_map(T, [&](const mrpt::math::TPoint2D&, double k) {
    sum += k;
    ++out.map_cells;
  });
  if (out.map_cells > 0) out.precision = sum / static_cast<double>(out.map_cells);
  sum = 0.0;
  visit_truth(T, [&](const mrpt::math::TPoint2D&, double k) {
    sum += k;
    ++out.truth_cells;
  });
  if (out.truth_cells > 0) out.recall = sum / static_cast<double>(out.truth_cells);
  out.score = std::min(out.precision, out.recall);
  return out;
}

Overlap WallOverlap::at(const PlanarTransform& T_truth_map) const { return measure(T_truth_map); }
Overlap WallOverlap::at(const Warp& warp) const { return measure(warp); }

std::vector<WallOverlap::Hit> WallOverlap::map_hits(const PlanarTransform& T_truth_map) const {
  std::vector<Hit> out;
  visit_map(T_truth_map, [&](const mrpt::math::TPoint2D& p, double k) { out.push_back({p, k}); });
  return out;
}

/// A truth that was seen from one side knows no more of a wall than its face: map walls that begin there and are no
/// thicker than the map's walls are, to a cell, are the same wall.
std::vector<WallOverlap::Hit> WallOverlap::ignored_hits(const PlanarTransform& T_truth_map) const {
  std::vector<Hit> out;
  const double same_wall = map_.half_thickness + truth_.grid->resolution();
  for (const mrpt::math::TPoint2D& p_map : map_.walls) {
    const mrpt::math::TPoint2D p_truth = T_truth_map(p_map);
    if (!known(*truth_.grid, p_truth))
      out.push_back({p_truth, truth_.field.distance(p_truth) <= same_wall ? 1.0 : truth_.kernel(p_truth, tau_)});
  }
  return out;
}

std::vector<WallOverlap::Hit> WallOverlap::truth_hits(const PlanarTransform& T_truth_map) const {
  std::vector<Hit> out;
  visit_truth(T_truth_map, [&](const mrpt::math::TPoint2D& p, double k) { out.push_back({p, k}); });
  return out;
}

Overlap overlap(const OccupancyGrid& map, const OccupancyGrid& truth, const mrpt::math::TPose2D& T_truth_map,
                double tau) {
  return WallOverlap(map, truth, tau).at(PlanarTransform(T_truth_map));
}

}  // namespace rubble::scoring
