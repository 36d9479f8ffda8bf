#pragma once

#include "explore/plan/traversable.h"

namespace rubble::explore {

/// The area that a look round from a cell is expected to show for the first time [m^2]: unknown cells that its rays
/// meet before anything occupied, up to a pallet into the unknown, for there the next wall is to be expected.
double expected_area(const Traversable& floor, Cell from);

}  // namespace rubble::explore
