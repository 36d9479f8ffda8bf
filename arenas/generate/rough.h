#pragma once

#include <string>
#include <vector>

#include "arenas/generate/generate.h"
#include "arenas/generate/maze.h"
#include "arenas/model/relief.h"
#include "base/rng.h"

namespace rubble::arenas {

/// A pallet with an element that a wheeled robot cannot cross, or (a tunnel) just about.
struct RoughPallet {
  Cell cell;
  std::string type;  ///< of the element, as in `elements`
  int turn = 0;      ///< quarter turns clockwise from north
  double top = 0.0;  ///< height of the elevated floor above the ground [m]; 0: none
  bool bars = true;  ///< a P3-AT cannot cross it
};

/// Chooses pallets for the obstacles of orange (step fields of 0.2 m, crossing ramps) and red arenas (step fields of
/// 0.4 m, stairs and steep ramps up to a floor, tunnels), about `share` of all. They lie on flat ground, never at the
/// start, and so that all other pallets stay connected without them. Ways up to a floor become dead ends: what was open
/// to their sides is closed.
std::vector<RoughPallet> lay_rough(ArenaKind kind, const Relief& relief, Cell start, double share, Maze& maze,
                                   Rng& rng);

}  // namespace rubble::arenas
