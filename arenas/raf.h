#pragma once

#include <map>
#include <string>

#include "arenas/arena.h"

namespace rubble::arenas {

/// What came of an arena file of the rescue arena designer. Nothing is dropped silently: every part is in one of the
/// three.
struct RafImport {
  Arena arena;
  std::map<std::string, int> built;    ///< parts with a shape, by type
  std::map<std::string, int> labels;   ///< known parts without a shape: signs, eye charts
  std::map<std::string, int> unknown;  ///< parts that are missing from the arena
  /// "160 parts built; without a shape: hazmat 1; UNKNOWN, left out: fire_extinguisher 2".
  std::string summary() const;
};

/// Reads a `.raf` file (XML, one element a part, 1 unit = one pallet of 1.2 m, rotation clockwise in degrees). The
/// ground is laid inside the outer walls; the robot starts near the pallet (0, 0). Throws InputError with file, line
/// and column.
RafImport import_raf(const std::string& path);

/// The same from text; `name` stands for the file in messages.
RafImport parse_raf(const std::string& text, const std::string& name);

}  // namespace rubble::arenas
