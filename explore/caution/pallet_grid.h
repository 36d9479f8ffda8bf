#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "base/grid.h"

namespace rubble::explore {

constexpr double kOnAnEdge = 0.1;      ///< so near to an edge of a pallet everything is a wall [m]
constexpr double kInsidePallet = 0.2;  ///< so far inside its pallet nothing is a wall on an edge [m]

/// The grid of an arena's pallets in the map frame. Rescue arenas are built of square elements side by side (paper,
/// section II.B), with walls on their edges: what was felt at the edge of one concerns the whole element.
struct PalletGrid {
  double size = 1.2;   ///< [m]
  double east = 0.0;   ///< along the grid's x axis the edges lie at east + k size [m]
  double north = 0.0;  ///< and along its y axis at north + k size [m]

  /// Of the grid's x axis in the map [rad], in (-pi/4, pi/4].
  double angle() const { return angle_; }
  void turn_to(double angle);
  /// Of the grid's x axis in the map; a unit vector.
  mrpt::math::TPoint2D direction() const { return {cosine_, sine_}; }
  /// In units of pallets: integers are edges.
  mrpt::math::TPoint2D to_grid(const mrpt::math::TPoint2D& p_map) const;
  mrpt::math::TPoint2D to_map(const mrpt::math::TPoint2D& p_grid) const;
  /// The pallet that holds a place.
  Cell pallet(const mrpt::math::TPoint2D& p_map) const;
  mrpt::math::TPoint2D middle(Cell pallet) const { return to_map({pallet.x + 0.5, pallet.y + 0.5}); }
  /// How far a place is inside the edges of its pallet [m].
  double depth(const mrpt::math::TPoint2D& p_map) const;

 private:
  double angle_ = 0.0;
  double cosine_ = 1.0;  ///< computed once: each plan asks for the places of thousands of cells
  double sine_ = 0.0;
};

/// The walls of a map about a place: all that the grid of the pallets there depends on.
class WallsAbout {
 public:
  WallsAbout() = default;
  /// Within `radius` of `around` [m].
  WallsAbout(const OccupancyGrid& cells, const mrpt::math::TPoint2D& around, double radius = 4.0);

  /// The grid that the walls show: their common direction, and where across it they stand. Nothing where too few walls
  /// agree. `size`: of a pallet [m].
  std::optional<PalletGrid> pallets(double size) const;

  friend bool operator==(const WallsAbout& a, const WallsAbout& b) {
    return a.frame_ == b.frame_ && a.low_ == b.low_ && a.high_ == b.high_ && a.first_ == b.first_ && a.xs_ == b.xs_;
  }

 private:
  friend class Surroundings;
  const int* begin(int y) const { return xs_.data() + first_[row(y)]; }
  const int* end(int y) const { return xs_.data() + first_[row(y) + 1]; }
  std::size_t row(int y) const { return static_cast<std::size_t>(y - lowest_); }

  GridFrame frame_;
  Cell low_, high_;                 ///< corners of what lies within `radius`; a little more was looked at
  int lowest_ = 0, highest_ = -1;   ///< rows looked at
  std::vector<int> xs_;             ///< of the occupied cells, row by row
  std::vector<std::size_t> first_;  ///< of each row
};

/// Finds the grid from the walls of the map within `radius` of a place [m]. A map that is bent has a grid of its own in
/// every part.
std::optional<PalletGrid> find_pallets(const OccupancyGrid& cells, double size, const mrpt::math::TPoint2D& around,
                                       double radius = 4.0);

}  // namespace rubble::explore
