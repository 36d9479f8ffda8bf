#pragma once

#include <mrpt/math/TPoint2D.h>

#include <optional>

#include "base/grid.h"

namespace rubble::explore {

/// The grid of an arena's pallets in the map frame. Rescue arenas are built of square elements side by side (paper,
/// section II.B), with walls on their edges: what was felt at the edge of one concerns the whole element.
struct PalletGrid {
  double size = 1.2;   ///< [m]
  double angle = 0.0;  ///< of the grid's x axis in the map [rad], in (-pi/4, pi/4]
  double east = 0.0;   ///< along the grid's x axis the edges lie at east + k size [m]
  double north = 0.0;  ///< and along its y axis at north + k size [m]

  /// In units of pallets: integers are edges.
  mrpt::math::TPoint2D to_grid(const mrpt::math::TPoint2D& p_map) const;
  mrpt::math::TPoint2D to_map(const mrpt::math::TPoint2D& p_grid) const;
  /// The pallet that holds a place.
  Cell pallet(const mrpt::math::TPoint2D& p_map) const;
  mrpt::math::TPoint2D middle(Cell pallet) const { return to_map({pallet.x + 0.5, pallet.y + 0.5}); }
  /// How far a place is inside the edges of its pallet [m].
  double depth(const mrpt::math::TPoint2D& p_map) const;
};

/// Finds the grid from the walls of the map within `radius` of a place [m]: their common direction, and where across it
/// they stand. Nothing where too few walls agree. A map that is bent has a grid of its own in every part.
std::optional<PalletGrid> find_pallets(const OccupancyGrid& cells, double size, const mrpt::math::TPoint2D& around,
                                       double radius = 4.0);

}  // namespace rubble::explore
