#pragma once

#include <cstdint>

#include "base/grid.h"

namespace rubble::explore {

/// Keeps of the cells that scans hit now and then those that can be sides of a victim's box: in straight rows of 0.3 to
/// 0.7 m, a cell or two thick. Longer ones are edges of ramps or the second row of a wall, which hides nothing that the
/// wall does not; shorter ones are blocks of a step field.
void keep_box_sides(Grid<std::uint8_t>& seen_over);

}  // namespace rubble::explore
