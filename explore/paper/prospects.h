#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <functional>

#include "explore/caution/local_grids.h"
#include "explore/plan/traversable.h"

namespace rubble::explore {

/// Smaller pieces of unknown ground are no way on, and may hold no more than a part of a pallet [m2].
constexpr double kPocket = 0.5;

/// How many frontiers the robot could get to if nothing that was felt was there: those behind a hole in a wall are none
/// of them, nor are those of pockets, nor what `settled` says is not to be had. `min_cells`: smaller ones are none.
std::size_t prospects(const Traversable& floor, const mrpt::math::TPose2D& T_map_base, int min_cells,
                      const std::function<bool(const mrpt::math::TPoint2D&)>& settled);

/// The floor if all that may be pushed aside was. `pallet`: size of the arena's elements, 0: of none [m]. `known`:
/// grids of earlier calls.
Traversable with_all_pushed(Traversable floor, double pallet, KnownGrids* known = nullptr);

}  // namespace rubble::explore
