#pragma once

#include <string>

#include "arenas/model/arena.h"

namespace rubble::arenas {

/// Reads an arena drawn as text in YAML (docs/arenas.md gives the format). Strict: an unknown or duplicate key, a bad
/// glyph or a start in a wall is an InputError `file:line:column: what, and the remedy`.
/// A path that ends in .raf is imported (arenas/raf.h); parts of unknown type are an InputError then.
Arena load_arena(const std::string& path);

/// The same from text; `name` stands for the file in messages.
Arena parse_arena(const std::string& yaml, const std::string& name);

}  // namespace rubble::arenas
