#pragma once

#include <string>
#include <vector>

#include "arenas/elements/elements.h"

namespace rubble::arenas {

/// The elements of a `.raf` text in the order of the file. Reads the part of XML that the arena designer writes: a
/// prolog, comments, <elements> and <element .../>. Throws InputError `name:line:column: ...`.
std::vector<Element> read_raf_elements(const std::string& text, const std::string& name);

}  // namespace rubble::arenas
