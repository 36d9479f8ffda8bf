#pragma once

#include <string>
#include <vector>

#include "arenas/files/piece.h"
#include "base/yaml/strict_yaml.h"

namespace rubble::arenas {

struct Inclusion;

/// An arena file and the files it includes, read but not put together.
struct ArenaFile {
  YamlMap root;
  std::string path;
  std::vector<Inclusion> includes;
};

/// An entry of `include` with its file.
struct Inclusion {
  YamlMap entry;
  PiecePlace place;
  ArenaFile file;
};

/// A file without its folders, for messages.
std::string short_name(const std::string& path);

/// Reads all files below `root`, which was read from `path`. Throws InputError: missing file, a file that includes
/// itself, a wrong entry.
ArenaFile read_arena_tree(const YamlMap& root, const std::string& path);

/// The settings of the whole arena, whichever file gives them; where two do, they must agree, else InputError.
YamlMap shared_settings(const ArenaFile& file);

}  // namespace rubble::arenas
