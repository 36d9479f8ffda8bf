#pragma once

#include <string>
#include <vector>

#include "base/grid.h"
#include "base/yaml/strict_yaml.h"

namespace rubble::arenas {

/// One pallet as drawn.
struct DrawnCell {
  char shape = ' ';  ///< ' ' no floor, '.' flat, '^' 'v' '<' '>' ramp that rises to that side, '#' block
  int level = 0;     ///< height of its foot in ramp rises
  char mark = 0;     ///< capital letter that names it, 'S' the start, 0 none
  int row = 0;       ///< where its middle is in the drawing, from 0
  int column = 0;
};

/// A maze as text: pallets three characters wide with walls on their edges. docs/arenas.md gives the glyphs.
struct Drawing {
  Grid<DrawnCell> cells;      ///< row 0 is the southernmost; frame in pallets
  std::vector<char> lying;    ///< '-' wall, ' ' open: edge y * columns + x lies south of cell (x, y); one row more
  std::vector<char> upright;  ///< '|' wall, ' ' open: edge y * (columns + 1) + x lies west of cell (x, y)

  bool wall_south(int x, int y) const { return lying[static_cast<std::size_t>(y * cells.width() + x)] != ' '; }
  bool wall_west(int x, int y) const { return upright[static_cast<std::size_t>(y * (cells.width() + 1) + x)] != ' '; }
};

/// Reads the block text `key`. Throws InputError that points at the line and column of a wrong glyph.
Drawing read_drawing(const YamlMap& map, const std::string& key);

/// The text of a drawing, one line a row, without a trailing blank: what read_drawing reads.
std::vector<std::string> draw(const Drawing& drawing);

}  // namespace rubble::arenas
