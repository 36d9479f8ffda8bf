#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace rubble {

/// Why `name` may not become part of a path that we make, with the remedy; nothing when it may. Refused: no text or
/// over 60 bytes, white space and control characters, / \ ' ", a dot or dash at the beginning (hidden, "..", or an
/// option).
std::optional<std::string> file_name_trouble(std::string_view name);

/// The nearest name that may: each refused letter becomes an underscore, what is too long is cut.
std::string as_file_name(std::string_view text);

}  // namespace rubble
