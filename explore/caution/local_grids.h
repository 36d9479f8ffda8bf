#pragma once

#include <mrpt/math/TPoint2D.h>

#include <map>
#include <optional>
#include <utility>

#include "base/grid.h"
#include "explore/caution/pallet_grid.h"

namespace rubble::explore {

/// The grid of the pallets about a place, found once for each square of the map: a map may be bent.
class LocalGrids {
 public:
  /// `cells` must outlive this. `pallet`: size of a pallet [m].
  LocalGrids(const OccupancyGrid& cells, double pallet) : cells_(cells), pallet_(pallet) {}
  /// Nothing where too few walls agree.
  const std::optional<PalletGrid>& at(const mrpt::math::TPoint2D& p_map);
  /// The same, or that of a square beside it where too few walls agree.
  const std::optional<PalletGrid>& near(const mrpt::math::TPoint2D& p_map);

 private:
  const OccupancyGrid& cells_;
  double pallet_;
  std::map<std::pair<int, int>, std::optional<PalletGrid>> grids_;
};

}  // namespace rubble::explore
