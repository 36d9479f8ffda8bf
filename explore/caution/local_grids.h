#pragma once

#include <mrpt/math/TPoint2D.h>

#include <map>
#include <optional>
#include <utility>

#include "base/grid.h"
#include "explore/caution/pallet_grid.h"

namespace rubble::explore {

/// Grids that were found, each with the walls that show it: as long as these stay, it need not be found again.
struct KnownGrid {
  WallsAbout walls;
  std::optional<PalletGrid> grid;
};
using KnownGrids = std::map<std::pair<int, int>, KnownGrid>;

/// The grid of the pallets about a place, found once for each square of the map: a map may be bent.
class LocalGrids {
 public:
  /// `cells` and `known` must outlive this. `pallet`: size of a pallet [m], the same for all that share `known`, which
  /// changes nothing but the time it takes.
  LocalGrids(const OccupancyGrid& cells, double pallet, KnownGrids* known = nullptr)
      : cells_(cells), pallet_(pallet), known_(known) {}
  LocalGrids(const LocalGrids&) = delete;
  LocalGrids& operator=(const LocalGrids&) = delete;
  /// Nothing where too few walls agree.
  const std::optional<PalletGrid>& at(const mrpt::math::TPoint2D& p_map);
  /// The same, or that of a square beside it where too few walls agree.
  const std::optional<PalletGrid>& near(const mrpt::math::TPoint2D& p_map);

 private:
  const std::optional<PalletGrid>& of_square(const std::pair<int, int>& key);

  const OccupancyGrid& cells_;
  double pallet_;
  KnownGrids* known_;
  std::map<std::pair<int, int>, std::optional<PalletGrid>> grids_;
  std::pair<int, int> last_key_;                          ///< of the square asked for last ...
  const std::optional<PalletGrid>* last_grid_ = nullptr;  ///< ... whose neighbours in a row are asked for next
};

}  // namespace rubble::explore
