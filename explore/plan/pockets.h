#pragma once

#include <cstdint>

#include "base/grid.h"

namespace rubble::explore {

/// The unknown cells that lie in pieces smaller than `most` [m2] with known ground all round: non-zero. What hides in a
/// barrel or between the steps of a field is seen of no way on.
Grid<std::uint8_t> pockets(const OccupancyGrid& cells, double most);

/// Whether a cell lies beside unknown ground that is in no pocket.
bool leads_on(const OccupancyGrid& cells, const Grid<std::uint8_t>& pockets, Cell c);

}  // namespace rubble::explore
