#pragma once

#include <string>

#include "base/yaml/strict_yaml.h"

namespace rubble::arenas {

/// The arena file with everything it includes put in its place: the drawings become one, the lists follow one another.
/// Values keep the places they came from, for messages. A document without `include` comes back as it is. `path`: of
/// the file; the paths in it are relative to its folder. Throws InputError with place and remedy.
YamlMap compose(const YamlMap& root, const std::string& path);

/// The text of an arena file that stands on its own: the file's as it is, or the composed one.
std::string self_contained_arena(const std::string& path);

}  // namespace rubble::arenas
