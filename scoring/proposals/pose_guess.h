#pragma once

#include <mrpt/math/TPose2D.h>

#include <functional>
#include <string>
#include <vector>

#include "base/grid.h"

namespace rubble::scoring {

/// What proposes poses; joined by | they propose together. Auto: none of them, or whichever it takes. Hand: a person.
/// Equation7: of what all of them propose, that which minimises eq. (7). Start: the known start pose.
enum class AlignBy : unsigned { Auto = 0, Walls = 1, Features = 2, Rooms = 4, Hand = 8, Equation7 = 16, Start = 32 };
constexpr AlignBy operator|(AlignBy a, AlignBy b) {
  return static_cast<AlignBy>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
constexpr bool includes(AlignBy set, AlignBy method) {
  return (static_cast<unsigned>(set) & static_cast<unsigned>(method)) != 0;
}

/// "walls+features+rooms"; "given" by hand, "eq7", "start"; empty for Auto.
std::string names_of(AlignBy methods);

/// A pose of the map in the truth that something speaks for.
struct PoseGuess {
  mrpt::math::TPose2D T_truth_map;
  double score = 0.0;  ///< comparable within one list only; higher is better
  AlignBy by = AlignBy::Auto;
};

/// Proposes poses without any hint, best first; none where it has nothing to say. Both grids cropped to what they know.
using Proposer = std::function<std::vector<PoseGuess>(const OccupancyGrid& map, const OccupancyGrid& truth)>;

}  // namespace rubble::scoring
