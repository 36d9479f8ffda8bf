#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <utility>
#include <vector>

#include "base/grid.h"
#include "slam/grid/count_map.h"

namespace rubble::slam {

/// Finds what a finished map still shows though it is no longer there: paper balls that were pushed on, people, phantom
/// hits of a tilted laser. Only things that stand alone and are small are asked about. One is gone when level scans saw
/// through it after it was seen last, some of them from where it had been seen before - what is merely too low is
/// overlooked there every time - or when the robot stood where it was.
class GoneThings {
 public:
  explicit GoneThings(const CountMap& map);

  bool any() const { return !things_.empty(); }
  /// Shows one scan, the next in the order of time; `level`: taken on level ground, and level.
  void look(const mrpt::math::TPose2D& T_map_base, const ScanPoints& points, bool level);
  /// Of the things that are gone.
  std::vector<Cell> cells() const;

 private:
  struct Thing {
    std::vector<Cell> cells;
    mrpt::math::TPoint2D centre;  ///< [m]
    double radius = 0.0;          ///< of all its cells around it [m]
    double core = 0.0;            ///< rays that pass the centre by less would meet it [m]
    std::vector<mrpt::math::TPoint2D> seen_from;
    // Since it was seen last:
    int passes = 0;
    int passes_from_there = 0;  ///< from where it was seen before
    bool driven_over = false;

    bool gone() const;
  };
  struct Ray {
    double bearing;  ///< [rad]
    double range;    ///< [m]
    bool hit;
  };
  void add(std::vector<Cell> cells);
  void see(Thing& thing, const mrpt::math::TPoint2D& from);
  /// Whether the scan under way saw through a thing, `away` [m] along a bearing.
  bool seen_through(const Thing& thing, double away, double bearing, double beam_width) const;

  GridFrame frame_;
  std::vector<Thing> things_;
  std::vector<bool> near_;                             ///< a bit a cell: of a thing or beside it
  std::vector<std::pair<std::size_t, int>> thing_at_;  ///< of such cells, by index
  std::vector<Ray> rays_;                              ///< of the scan under way, by bearing
  std::vector<char> hit_;                              ///< things that it hit
};

}  // namespace rubble::slam
