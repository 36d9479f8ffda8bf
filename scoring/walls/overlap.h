#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <vector>

#include "base/grid.h"
#include "base/planar.h"
#include "scoring/walls/wall_field.h"
#include "scoring/walls/warp.h"

namespace rubble::scoring {

/// How well the walls of two maps lie on each other, k(d) = clip(1 - d / tau, 0, 1).
struct Overlap {
  double precision = 0.0;       ///< mean k over the map's wall cells of the distance to the truth's walls
  double recall = 0.0;          ///< mean k over the truth's wall cells of the distance to the map's walls
  double score = 0.0;           ///< min(precision, recall)
  std::size_t map_cells = 0;    ///< map walls that counted: those the truth knows anything about
  std::size_t truth_cells = 0;  ///< truth walls that counted: all of them
};

/// Two maps prepared for measuring how their walls overlap at many poses.
///
/// Distances go to the edge of the wall cell (half a cell less than to its centre). Map walls where the truth is
/// unknown are ignored. All truth walls count, so what the map does not know costs recall.
///
/// Thick walls reach further: without care, fattening every wall of a map would pull up its recall. So the half
/// thickness (area / boundary) by which one map's walls are fatter than the other's is added to the distances to them.
/// No walls in either map: 0.
class WallOverlap {
 public:
  WallOverlap(const OccupancyGrid& map, const OccupancyGrid& truth, double tau);
  Overlap at(const PlanarTransform& T_truth_map) const;
  Overlap at(const Warp& warp) const;

  /// What one wall cell counts, k(d), with where it lies in the truth.
  struct Hit {
    mrpt::math::TPoint2D p_truth;
    double k = 0.0;
  };
  std::vector<Hit> map_hits(const PlanarTransform& T_truth_map) const;  ///< of the map's walls that count
  std::vector<Hit> ignored_hits(
      const PlanarTransform& T_truth_map) const;  ///< of those that do not: the truth is unknown there
  std::vector<Hit> truth_hits(const PlanarTransform& T_truth_map) const;  ///< of the truth's walls
  double tau() const { return tau_; }
  double map_length_of_cell() const { return map_.cell_length; }  ///< metres of wall that one cell stands for
  double truth_length_of_cell() const { return truth_.cell_length; }

 private:
  struct Side {
    Side(const OccupancyGrid& grid, double tau);
    const OccupancyGrid* grid;
    WallField field;
    std::vector<mrpt::math::TPoint2D> walls;
    double half_thickness = 0.0;
    double excess = 0.0;  ///< by which these walls are fatter than the other map's, halved [m]
    double cell_length = 0.0;
    double kernel(const mrpt::math::TPoint2D& p, double tau) const;
  };
  template <class Transform, class Take>
  void visit_map(const Transform& T, const Take& take) const;
  template <class Transform, class Take>
  void visit_truth(const Transform& T, const Take& take) const;
  template <class Transform>
  Overlap measure(const Transform& T) const;

  double tau_;
  Side map_;
  Side truth_;
};

/// The same for one pose.
Overlap overlap(const OccupancyGrid& map, const OccupancyGrid& truth, const mrpt::math::TPose2D& T_truth_map,
                double tau);

/// Mean half thickness of the walls [m]: area over boundary length, the latter by Cauchy-Crofton in four directions so
/// that it does not depend on how the walls lie on the grid (within 5 %). What is solid for more than 0.6 m (the ground
/// around a plan, filled with black) does not count; 0.3 m where there is nothing else, 0 without walls.
double wall_half_thickness(const OccupancyGrid& grid);

}  // namespace rubble::scoring
