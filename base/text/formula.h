#pragma once

#include <string>

namespace rubble {

/// `text`, with an apostrophe before it when a spreadsheet would take it for a formula and run it: = @ tab or return
/// first, or a sign that no number follows.
std::string not_a_formula(const std::string& text);

}  // namespace rubble
