#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <vector>

#include "base/angle.h"
#include "explore/plan/traversable.h"

namespace rubble::explore {

/// What the explorer counts on from the robot's victim sensors.
struct SearchConfig {
  bool on = true;                           ///< look for victims everywhere before finishing
  double field_of_view = deg_to_rad(50.0);  ///< full angle, ahead of the robot; less than the sensor's: poses err
  double range = 1.8;                       ///< [m]; likewise
  int min_cells = 16;                       ///< smaller unsearched places are left alone
  double stare = 3.0;                       ///< a cue not yet confirmed holds the robot at most this long [s]
  double dwell = 1.2;                       ///< time at a viewpoint, facing the place to search [s]
};

/// The floor the victim sensors have looked at. Places mapped from afar are known but not searched ("inner
/// exploration").
class SearchedArea {
 public:
  explicit SearchedArea(const SearchConfig& config) : config_(config) {}

  /// Marks the free floor in view from T_map_base: in the cone, in range, nothing occupied or unknown between.
  void look(const Traversable& floor, const mrpt::math::TPose2D& T_map_base);
  /// Marks everything within `radius` of a place that turned out not to be visible.
  void give_up(const Traversable& floor, const mrpt::math::TPoint2D& place, double radius);
  /// Whether a cell of `floor` was looked at.
  bool searched(const Traversable& floor, Cell c) const;
  /// 1 where a cell of `floor` is free and was not looked at; its outermost cells are 0.
  Grid<std::uint8_t> unsearched(const Traversable& floor) const;

 private:
  /// What to add to a cell of `frame` to get the record's own.
  Cell shift_from(const GridFrame& frame) const;
  void cover(const GridFrame& frame);

  SearchConfig config_;
  Grid<std::uint8_t> searched_;
};

constexpr double kAtViewpoint = 0.12;  ///< viewpoints this close are served from where the robot stands [m]

/// A place from which an unsearched part of the floor can be seen.
struct Viewpoint {
  Cell cell;
  mrpt::math::TPoint2D subject;  ///< what to face there [m]
};

/// Viewpoints with at least `d_min` clearance for every unsearched cluster of free floor, in raster order.
std::vector<Viewpoint> viewpoints(const Traversable& floor, const SearchedArea& searched, const SearchConfig& config,
                                  double d_min);

/// True when all cells between two cells of the floor are free (the last one included).
bool in_sight(const Traversable& floor, Cell from, Cell to);

}  // namespace rubble::explore
