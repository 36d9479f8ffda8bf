#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "arenas/elements/elements.h"
#include "arenas/model/arena.h"
#include "base/grid.h"

// The pallets of a league file and what stands on and between them.

namespace rubble::arenas {

/// The pallets of the file as a grid with a rim of one pallet all round.
struct Layout {
  Grid<std::uint8_t> occupied;       ///< something other than a wall stands or lies here
  Grid<std::uint8_t> covered;        ///< a floor hides the ground
  Grid<std::array<bool, 4>> walled;  ///< sides with a wall, in the order of rotation 0, 90, 180, 270 deg

  explicit Layout(const GridFrame& frame) : occupied(frame), covered(frame), walled(frame) {}
  Cell cell(const Element& e) const { return occupied.cell(e.position); }
};

/// The pallet beside one, by rotation 0, 90, 180, 270 deg: 0 to 3.
Cell step(Cell c, std::size_t direction);

bool is_quarter_turn(const Element& element);

Layout layout_of(const std::vector<Element>& elements);

/// Flat floor on every pallet inside the arena that has none of its own; on all pallets when the arena is open.
void lay_ground(const Layout& layout, Arena& arena);

}  // namespace rubble::arenas
