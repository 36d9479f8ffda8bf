#pragma once

#include "explore/caution/local_grids.h"
#include "explore/plan/traversable.h"

namespace rubble::explore {

/// Makes free what is drawn well inside the arena's pallets and is neither a side of a box nor as wide as a field of
/// steps, nor `solid` and wide: walls stand on the edges of the pallets, so it is floor that the laser met from the
/// foot of a slope, or paper beside a wall. Where the walls show no such grid nothing is made free. `pallet`: size of a
/// pallet, 0: there are none [m]. `floor_only`: but no small things. `known`: grids of earlier calls. Says whether
/// there was any.
bool free_off_grid(Traversable& floor, double pallet, bool floor_only = false, KnownGrids* known = nullptr);

}  // namespace rubble::explore
