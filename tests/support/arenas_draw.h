#pragma once

#include <initializer_list>
#include <string>

#include "arenas/files/arena_file.h"

namespace rubble::testing {

/// The YAML text of an arena drawn in the test; `more` holds further keys.
inline std::string arena_text(std::initializer_list<const char*> maze, const std::string& more = "") {
  std::string text = "maze: |\n";
  for (const char* line : maze) text += std::string("  ") + line + "\n";
  return text + more;
}

inline arenas::Arena arena(std::initializer_list<const char*> maze, const std::string& more = "") {
  return arenas::parse_arena(arena_text(maze, more), "test.yaml");
}

}  // namespace rubble::testing
