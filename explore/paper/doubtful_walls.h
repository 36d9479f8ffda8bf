#pragma once

#include <cstdint>
#include <vector>

#include "base/grid.h"
#include "explore/caution/local_grids.h"
#include "explore/plan/exploration_transform.h"
#include "explore/plan/traversable.h"

namespace rubble::explore {

/// Places to look from at walls that may be none. A level laser that looks up a slope from its foot sees a wall where
/// its plane meets the floor: on ramps of 10 deg, 0.35 m up, 2 m behind their foot. From wall to wall such a phantom
/// shuts a corridor, without a frontier that would ask for more; seen from nearer, so from higher up, it moves away.
/// Real walls stand on the edges of the arena's pallets, phantoms anywhere. So: a row of occupied cells along the grid
/// of the pallets, at least 0.5 m long (the side of a victim's box is 0.4 m) and 0.25 m off their edges, that has free
/// floor on one side and unknown on the other. On an edge it is one if four fifths of its cells, and all that is drawn
/// within 0.25 m behind these, are `unsure`. What is `solid` was looked at.
/// The clearance of `floor` is measured. `pallet`: size of the arena's elements [m]; 0: nothing. The sources are in
/// raster order of the walls, without head start; each is 0.5 or 0.6 m before its wall, in free sight of it. `pockets`:
/// unknown ground that is none worth the look; null: all is. `known`: grids of earlier calls.
std::vector<Source> doubtful_walls(const Traversable& floor, double pallet, const Grid<std::uint8_t>* pockets = nullptr,
                                   KnownGrids* known = nullptr);

}  // namespace rubble::explore
