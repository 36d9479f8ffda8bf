#pragma once

#include <map>
#include <string>
#include <vector>

#include "arenas/elements/elements.h"
#include "arenas/model/arena.h"

namespace rubble::arenas {

/// What came of an arena file of the rescue arena designer. Nothing is dropped silently: every part is in one of the
/// three.
struct RafImport {
  Arena arena;
  std::vector<Element> elements;       ///< the parts with a shape, in the order of the file
  std::map<std::string, int> built;    ///< parts with a shape, by type
  std::map<std::string, int> labels;   ///< known parts without a shape: signs, eye charts
  std::map<std::string, int> unknown;  ///< parts that are missing from the arena
  std::map<std::string, int> askew;    ///< parts that stand at other than quarter turns
  std::string start_note;              ///< where the robot starts, and why there
  /// "160 parts built; without a shape: hazmat 1; UNKNOWN, left out: fire_extinguisher 2".
  std::string summary() const;
  /// What whoever uses the arena should know, one line each: parts left out, parts askew, the start.
  std::vector<std::string> notes() const;
};

/// Whether a file's name ends in .raf.
bool is_raf(const std::string& path);

/// Reads a `.raf` file (XML, one element a part, 1 unit = one pallet of 1.2 m, rotation clockwise in degrees). The
/// ground is laid inside the outer walls. The robot starts at a part named start..., where it gets to at least half as
/// much floor from there as from elsewhere; else inside the largest stretch of floor it can drive on. Throws InputError
/// with file, line and column.
RafImport import_raf(const std::string& path);

/// The same from text; `name` stands for the file in messages.
RafImport parse_raf(const std::string& text, const std::string& name);

/// The import as an arena file to edit (docs/arenas.md): the ground as a drawing, the parts as `elements`. Its origin
/// is the south-western corner of the drawing. What could not be built is named in a comment.
std::string to_yaml(const RafImport& import);

}  // namespace rubble::arenas
